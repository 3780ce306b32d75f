//! `make mutants`: makes the mistakes of `host-tests/mutants.txt` in a copy of the tree,
//! one at a time, and reports those that no test notices.
//!
//! Most of the code in that list is the board's: it runs nowhere but in the firmware, so
//! no tool for host crates reaches it. The entries of the core must be found by trouble
//! at random moments in the running image or, if an entry names a package, by that
//! package's own tests. The tests are built once, from the tree as it is, and given each
//! mistaken firmware by LIZARD_ELF.
//!
//! Run it from the folder `host`. Arguments: parts of a file's name or of the
//! sentence that says what is wrong; an entry that has one of them is tried. None: all.

mod list;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use list::Mutant;

/// The longest that tests may take, or the mistake makes them hang.
const PATIENCE: Duration = Duration::from_secs(1800);

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// What became of a mistake.
enum Fate {
    Caught(String),
    Lives,
}

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(sentence) => {
            eprintln!("mutants: {sentence}");
            ExitCode::from(2)
        }
    }
}

/// Returns how many live.
fn run(parts: &[String]) -> Result<usize, String> {
    let path = root().join("host-tests/mutants.txt");
    let list = list::read(&text(&path)?).map_err(|error| format!("mutants.txt, {error}"))?;
    // All old texts first: a list that is out of date is an error, whatever is tried.
    for mutant in &list {
        let made = mutant.make(&text(&root().join(&mutant.file))?);
        made.map_err(|e| format!("mutants.txt, line {}: {}: {e}", mutant.line, mutant.file))?;
    }
    let wanted = |mutant: &&Mutant| {
        let named = |part: &String| mutant.file.contains(part) || mutant.wrong.contains(part);
        parts.is_empty() || parts.iter().any(named)
    };
    let list: Vec<&Mutant> = list.iter().filter(wanted).collect();
    let scratch = Scratch::copy()?;
    let is_of_board = |mutant: &&&Mutant| mutant.package.is_none();
    if list.iter().find(is_of_board).is_some()
        && !tests(&scratch.firmware()?, "")?.is_none_or(|failed| failed.is_empty())
    {
        return Err("a test fails without any mistake".into());
    }
    let mut lives = Vec::new();
    for mutant in &list {
        let begin = Instant::now();
        let fate = scratch.judge(mutant)?;
        let fate = match &fate {
            Fate::Caught(test) => format!("caught by {test}"),
            Fate::Lives => {
                lives.push(mutant);
                "LIVES".to_owned()
            }
        };
        let seconds = begin.elapsed().as_secs();
        println!("{}: {}: {fate} ({seconds} s)", mutant.file, mutant.wrong);
    }
    println!(
        "{} mistakes, {} noticed, {} live",
        list.len(),
        list.len() - lives.len(),
        lives.len()
    );
    for mutant in &lives {
        println!("lives: mutants.txt, line {}: {}", mutant.line, mutant.wrong);
    }
    Ok(lives.len())
}

fn text(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// A copy of the tree to make mistakes in, with build folders of its own.
struct Scratch {
    folder: PathBuf,
}

impl Scratch {
    /// Copies what git knows of, as it is in the working tree.
    fn copy() -> Result<Self, String> {
        let folder = root().join("target/mutants");
        let listed = Command::new("git")
            .args(["ls-files", "-z"])
            .current_dir(root())
            .output()
            .map_err(|error| format!("git: {error}"))?;
        let scratch = Self { folder };
        for name in String::from_utf8_lossy(&listed.stdout).split_terminator('\0') {
            let from = root().join(name);
            if from.is_file() {
                scratch.write(name, &fs::read(&from).map_err(|e| format!("{name}: {e}"))?)?;
            }
        }
        Ok(scratch)
    }

    /// Writes a file of the copy, unless it holds that already: a build looks at times.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let path = self.folder.join("tree").join(name);
        if fs::read(&path).is_ok_and(|before| before == bytes) {
            return Ok(());
        }
        let parent = path.parent().ok_or("a file is in a folder")?;
        let written = fs::create_dir_all(parent).and_then(|()| fs::write(&path, bytes));
        written.map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Builds the firmware of the copy.
    fn firmware(&self) -> Result<PathBuf, String> {
        let build = self.folder.join("build");
        let status = Command::new("cargo")
            .args(["build", "--release", "--quiet"])
            .current_dir(self.folder.join("tree"))
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_TARGET_DIR", &build)
            .stderr(Stdio::null())
            .status()
            .map_err(|error| format!("cargo: {error}"))?;
        if !status.success() {
            return Err("it does not build".into());
        }
        Ok(build.join("avr-atmega328p/release/lizard.elf"))
    }

    /// Makes a mistake, tests, and puts it right.
    fn judge(&self, mutant: &Mutant) -> Result<Fate, String> {
        let right = text(&root().join(&mutant.file))?;
        self.write(&mutant.file, mutant.make(&right)?.as_bytes())?;
        let fate = match (&mutant.compiled_by, &mutant.package) {
            (Some(test), _) => self.alone(test),
            (None, Some(package)) => self.in_its_package(package, mutant),
            (None, None) => self.in_the_firmware(mutant),
        };
        self.write(&mutant.file, right.as_bytes())?;
        fate.map_err(|error| format!("{}: {}: {error}", mutant.file, mutant.wrong))
    }

    fn in_the_firmware(&self, mutant: &Mutant) -> Result<Fate, String> {
        let elf = self.firmware()?;
        // The likely ones first: all of them take a minute.
        for filter in mutant.test.as_deref().into_iter().chain([""]) {
            match tests(&elf, filter)? {
                None => return Ok(Fate::Caught("tests that hang".into())),
                Some(failed) if !failed.is_empty() => return Ok(Fate::Caught(failed.join(", "))),
                Some(_) => {}
            }
        }
        Ok(Fate::Lives)
    }

    /// Runs the tests of a package of the copy: those that are to notice, then all.
    fn in_its_package(&self, package: &str, mutant: &Mutant) -> Result<Fate, String> {
        for filter in mutant.test.as_deref().into_iter().chain([""]) {
            let run = Command::new("cargo")
                .args(["test", "--no-fail-fast", "-p", package, "--", filter])
                .current_dir(self.folder.join("tree/host"))
                .env("CARGO_TARGET_DIR", self.folder.join("host"))
                .env("PROPTEST_RNG_SEED", "1")
                .env("RUST_BACKTRACE", "0")
                .stderr(Stdio::null())
                .output()
                .map_err(|error| format!("cargo: {error}"))?;
            let said = String::from_utf8_lossy(&run.stdout);
            if !said.lines().any(|line| line.starts_with("test ")) {
                return Err(format!(
                    "no test of {package} has {filter:?} in its name, or it does not build"
                ));
            }
            let failed = failures(&said);
            if !failed.is_empty() {
                return Ok(Fate::Caught(failed.join(", ")));
            }
        }
        Ok(Fate::Lives)
    }

    /// Compiles and runs one test file of the copy without cargo.
    fn alone(&self, test: &str) -> Result<Fate, String> {
        let program = self.folder.join("alone");
        let built = Command::new("rustc")
            .args(["--edition=2024", "--test", "-o"])
            .arg(&program)
            .arg(self.folder.join("tree").join(test))
            .stderr(Stdio::null())
            .status();
        if !built.is_ok_and(|status| status.success()) {
            return Err("it does not build".into());
        }
        let run = Command::new(&program).output().map_err(|e| e.to_string())?;
        let failed = failures(&String::from_utf8_lossy(&run.stdout));
        Ok(if failed.is_empty() {
            Fate::Lives
        } else {
            Fate::Caught(failed.join(", "))
        })
    }
}

/// Runs those of the firmware's tests whose names have `filter` in them. Returns the
/// names of those that fail, or nothing if they do not end.
fn tests(elf: &Path, filter: &str) -> Result<Option<Vec<String>>, String> {
    let output = root().join("target/mutants/tests.txt");
    let file = fs::File::create(&output).map_err(|error| error.to_string())?;
    let mut run = Command::new("cargo")
        .args([
            "test",
            "-p",
            "lizard-host-tests",
            "--test",
            "firmware",
            "--test",
            "trouble",
            "--",
        ])
        .arg(filter)
        .current_dir(root().join("host"))
        .env("LIZARD_ELF", elf)
        .env("LIZARD_FUZZ", "5") // as long as in continuous integration
        .env("PROPTEST_RNG_SEED", "1")
        .env("RUST_BACKTRACE", "0")
        .stdout(file)
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("cargo: {error}"))?;
    let begin = Instant::now();
    while run.try_wait().map_err(|error| error.to_string())?.is_none() {
        if begin.elapsed() > PATIENCE {
            _ = run.kill();
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let said = text(&output)?;
    if !said.contains("test result:") {
        return Err("the tests of the firmware do not run; try make test".into());
    }
    Ok(Some(failures(&said)))
}

/// The tests that failed, by their harness's lines.
fn failures(said: &str) -> Vec<String> {
    let name = |line: &str| {
        Some(
            line.strip_prefix("test ")?
                .strip_suffix(" ... FAILED")?
                .to_owned(),
        )
    };
    said.lines().filter_map(name).collect()
}
