//! `make mutants`: mutation tests of the firmware. The program applies the mutants in `host-tests/mutants.txt` to a
//! copy of the tree, one at a time, and reports mutants that no test catches.
//!
//! Most of the listed mutants are in the board's code. That code runs only in the firmware, so no mutation testing tool
//! for host crates reaches it. If a mutant's entry names a package, the package's own tests must catch the mutant,
//! otherwise the tests of the running firmware. The firmware's tests are built once, from the unchanged tree; the
//! environment variable LIZARD_ELF names the firmware under test.
//!
//! Run the program from the folder `crates`. Each argument is a part of a file's name or of a mutant's description. The
//! program tries the entries that match at least one argument, or all entries if there is no argument.
//!
//! With SAMPLE=60 the program instead tries a random sample of 60 generated mutants ([`generated`]) from all of the
//! firmware's code, or from the files whose paths contain an argument, and prints the rate at which tests catch them,
//! with its confidence interval. SEED selects the sample. For a mutant in the core, the core's own tests run first,
//! then the model checker's tests, then the tests of the running firmware.

mod generated;
mod list;

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

use list::Mutant;
use lizard_host_tests::{read_number, root};

/// Time after which a test run counts as hanging, s.
const TIMEOUT_S: u32 = 1_800;

/// Processor time after which a test program counts as hanging, s. The longest that does not hang takes 220 s.
const CPU_TIMEOUT_S: u32 = 400;

/// The outcome of the tests with a mutant.
enum Outcome {
    /// At least one test caught the mutant. The text names the failed tests, or says that the tests hang or crash.
    Caught(String),
    /// No test caught the mutant.
    Missed,
    /// The mutant does not compile.
    DoesNotCompile,
}

fn main() -> ExitCode {
    let filters: Vec<String> = std::env::args().skip(1).collect();
    let seed = read_number("SEED").unwrap_or(1);
    let outcome = match read_number("SAMPLE") {
        Some(count) => try_generated_mutants(&filters, count as usize, seed),
        None => try_listed_mutants(&filters),
    };
    match outcome {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("mutants: {message}");
            ExitCode::from(2)
        }
    }
}

/// Tries `count` generated mutants. Returns the number of mutants that no test catches.
fn try_generated_mutants(filters: &[String], count: usize, seed: u64) -> Result<usize, String> {
    let scratch = ScratchTree::copy()?;
    let mut mutants = Vec::new();
    for file in &scratch.files {
        let is_selected = filters.is_empty() || filters.iter().any(|part| file.contains(part));
        if is_selected && generated::is_mutated(file) {
            let text = read_text(&root().join(file))?;
            mutants.extend(generated::generate_mutants(file, &text));
        }
    }
    let generated_count = mutants.len();
    let sample_count = generated_count.min(count);
    if sample_count == 0 {
        return Err("SAMPLE and ONLY select no mutant".into());
    }
    println!("seed {seed}: {sample_count} of {generated_count} generated mutants");
    compile_firmware_tests()?;
    let file = "crates/core/src/lib.rs";
    let unchanged = Mutant::without_change_in_core(file, read_text(&root().join(file))?);
    if !matches!(scratch.try_mutant(&unchanged)?, Outcome::Missed) {
        return Err("a test fails or hangs in the unchanged tree".into());
    }
    // The numbers of caught and of tried mutants, first for code that affects a servo or a saved value, then for
    // code that only produces text.
    let mut tally = [[0; 2]; 2];
    fastrand::Rng::with_seed(seed).shuffle(&mut mutants);
    for mutant in mutants {
        if tally.iter().map(|[_, tried]| tried).sum::<usize>() == count {
            break;
        }
        let outcome = match scratch.try_mutant(&mutant)? {
            Outcome::DoesNotCompile => continue,
            // Up to a hundred tests may catch a mutant; the first is enough.
            Outcome::Caught(test) => {
                format!("caught by {}", test.split(',').next().unwrap_or(&test))
            }
            Outcome::Missed => "MISSED".to_owned(),
        };
        println!("{}, {}: {outcome}", mutant.file, mutant.description);
        let [caught, tried] =
            &mut tally[usize::from(!generated::affects_servos_or_memory(&mutant.file))];
        *caught += usize::from(outcome != "MISSED");
        *tried += 1;
    }
    let code_kinds = ["that can move a servo or change a saved value", "in text"];
    for ([caught, tried], code_kind) in tally.into_iter().zip(code_kinds) {
        let (min, max) = generated::wilson_interval(caught, tried);
        let interval = format!("{:.1} to {:.1} % (Wilson, 95 %)", 100.0 * min, 100.0 * max);
        println!("mutants {code_kind}: {caught} of {tried} caught, {interval}");
    }
    Ok(tally.iter().map(|[caught, tried]| tried - caught).sum())
}

/// Tries the listed mutants. Returns the number of mutants that no test catches.
fn try_listed_mutants(filters: &[String]) -> Result<usize, String> {
    let list = read_list()?;
    let is_selected = |mutant: &&Mutant| {
        let texts = [&mutant.file, &mutant.description];
        let matches_part = |part: &String| texts.iter().any(|text| text.contains(part));
        filters.is_empty() || filters.iter().any(matches_part)
    };
    let list: Vec<&Mutant> = list.iter().filter(is_selected).collect();
    if list.is_empty() {
        return Err("ONLY selects no mutant".into());
    }
    let scratch = ScratchTree::copy()?;
    if list.iter().any(|mutant| mutant.package.is_none()) {
        compile_firmware_tests()?;
        let elf = scratch
            .build_firmware()?
            .ok_or("the unchanged firmware does not build in target/mutants/tree")?;
        let failed = run_firmware_tests(&elf, "")?.unwrap_or(vec!["a test hangs".into()]);
        if !failed.is_empty() {
            return Err(format!(
                "tests fail with the unchanged firmware: {}",
                failed.join(", ")
            ));
        }
    }
    let mut missed_mutants = Vec::new();
    for mutant in &list {
        let start = Instant::now();
        let (file, description) = (&mutant.file, &mutant.description);
        let outcome = match scratch.try_mutant(mutant)? {
            Outcome::Caught(test) => format!("caught by {test}"),
            Outcome::Missed => {
                missed_mutants.push(mutant);
                "MISSED".to_owned()
            }
            Outcome::DoesNotCompile => {
                return Err(format!("{description}: the mutant does not compile"));
            }
        };
        let seconds = start.elapsed().as_secs();
        println!("{file}: {description}: {outcome} ({seconds} s)");
    }
    let (count, missed_count) = (list.len(), missed_mutants.len());
    let caught_count = count - missed_count;
    println!("{count} mutants, {caught_count} caught, {missed_count} missed");
    for mutant in missed_mutants {
        let (line, description) = (mutant.line, &mutant.description);
        println!("missed: mutants.txt, line {line}: {description}");
    }
    Ok(missed_count)
}

/// Reads the list of mutants and checks the old texts of all entries, so that an outdated list is an error even if
/// only some of its mutants are tried.
fn read_list() -> Result<Vec<Mutant>, String> {
    let path = root().join("host-tests/mutants.txt");
    let list = list::parse(&read_text(&path)?).map_err(|error| format!("mutants.txt, {error}"))?;
    for mutant in &list {
        let result = mutant.apply(&read_text(&root().join(&mutant.file))?);
        result.map_err(|e| format!("mutants.txt, line {}: {}: {e}", mutant.line, mutant.file))?;
    }
    Ok(list)
}

fn read_text(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// A copy of the tree to which mutants are applied, with its own build folders.
struct ScratchTree {
    folder: PathBuf,
    /// The paths of the copied files, relative to the root of the tree.
    files: Vec<String>,
}

impl ScratchTree {
    /// Copies all files that git tracks, as they are in the working tree.
    fn copy() -> Result<Self, String> {
        let folder = root().join("target/mutants");
        let output = Command::new("git")
            .args(["ls-files", "-z"])
            .current_dir(root())
            .output()
            .map_err(|error| format!("git: {error}"))?;
        let listing = String::from_utf8_lossy(&output.stdout);
        let names = listing.split_terminator('\0');
        let files = names.filter(|name| root().join(name).is_file());
        let files = files.map(str::to_owned).collect();
        let scratch = Self { folder, files };
        for name in &scratch.files {
            let source = root().join(name);
            let bytes = fs::read(&source).map_err(|error| format!("{name}: {error}"))?;
            scratch.write(name, &bytes)?;
            // The build executes scripts/link.
            let copy = scratch.folder.join("tree").join(name);
            fs::metadata(source)
                .and_then(|metadata| fs::set_permissions(copy, metadata.permissions()))
                .map_err(|error| format!("{name}: {error}"))?;
        }
        Ok(scratch)
    }

    /// Writes a file of the copy, unless the file already has these bytes, because a new modification time would make
    /// cargo rebuild.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let path = self.folder.join("tree").join(name);
        if fs::read(&path).is_ok_and(|old_bytes| old_bytes == bytes) {
            return Ok(());
        }
        let parent = path.parent().ok_or("the file has no folder")?;
        let result = fs::create_dir_all(parent).and_then(|()| fs::write(&path, bytes));
        result.map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Builds the copy's firmware and returns the path of its ELF file; `None` if the firmware does not compile.
    fn build_firmware(&self) -> Result<Option<PathBuf>, String> {
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
            return Ok(None);
        }
        let elf = build.join("avr-atmega328p/release/lizard.elf");
        // A test of the firmware also loads the HEX file, which `make firmware` makes beside the ELF file.
        let status = Command::new("avr-objcopy")
            .args(["-O", "ihex", "-R", ".eeprom"])
            .args([&elf, &elf.with_extension("hex")])
            .status()
            .map_err(|error| format!("avr-objcopy: {error}"))?;
        Ok(status.success().then_some(elf))
    }

    /// Applies a mutant, runs the tests and restores the file.
    fn try_mutant(&self, mutant: &Mutant) -> Result<Outcome, String> {
        // Reads the text from the copy, because the original tree may be edited during the run.
        let correct_text = read_text(&self.folder.join("tree").join(&mutant.file))?;
        self.write(&mutant.file, mutant.apply(&correct_text)?.as_bytes())?;
        let outcome = match &mutant.package {
            Some(package) => self.test_in_package(package, mutant),
            None => self.test_in_firmware(mutant),
        };
        self.write(&mutant.file, correct_text.as_bytes())?;
        outcome.map_err(|error| format!("{}: {}: {error}", mutant.file, mutant.description))
    }

    /// Builds the copy's firmware and runs the tests of the running firmware.
    fn test_in_firmware(&self, mutant: &Mutant) -> Result<Outcome, String> {
        let Some(elf) = self.build_firmware()? else {
            return Ok(Outcome::DoesNotCompile);
        };
        // The tests that are likely to fail run first, because all tests together take a minute.
        for filter in mutant.test_filter.as_deref().into_iter().chain([""]) {
            match run_firmware_tests(&elf, filter)? {
                None => return Ok(Outcome::Caught("a time-out".into())),
                Some(failed_tests) if !failed_tests.is_empty() => {
                    return Ok(Outcome::Caught(failed_tests.join(", ")));
                }
                Some(_) => {}
            }
        }
        Ok(Outcome::Missed)
    }

    /// Runs the tests of a package in the copy: first the tests that should catch the mutant, then all. For a
    /// generated mutant, also runs the tests of the model checker and of the running firmware.
    fn test_in_package(&self, package: &str, mutant: &Mutant) -> Result<Outcome, String> {
        let build = self.run_package_tests(package, &["--no-run"])?;
        if !matches!(build, Some((true, _))) {
            return Ok(Outcome::DoesNotCompile);
        }
        let is_generated = mutant.is_generated;
        let filters = mutant.test_filter.as_deref().into_iter().chain([""]);
        let runs = filters.map(|filter| (package, filter));
        for (package, filter) in runs.chain(is_generated.then_some(("lizard-explore", ""))) {
            match self.run_package_tests(package, &["--no-fail-fast", "--", filter])? {
                None => return Ok(Outcome::Caught("a time-out".into())),
                Some((false, output_text)) => {
                    let failed_tests = find_failed_tests(&output_text);
                    return Ok(Outcome::Caught(match failed_tests.is_empty() {
                        true => format!("a crash of {package}"),
                        false => failed_tests.join(", "),
                    }));
                }
                Some((true, output_text)) if !has_run_a_test(&output_text) => {
                    return Err(format!("no test of {package} has {filter:?} in its name"));
                }
                Some(_) => {}
            }
        }
        match is_generated {
            true => self.test_in_firmware(mutant),
            false => Ok(Outcome::Missed),
        }
    }

    /// Runs `cargo test` on a package in the copy. Returns true if the tests passed, and their output; `None` if the
    /// tests hang.
    fn run_package_tests(
        &self,
        package: &str,
        arguments: &[&str],
    ) -> Result<Option<(bool, String)>, String> {
        run_cargo_test(
            &self.folder.join("tree/crates"),
            &[&["-p", package], arguments].concat(),
            &[("CARGO_TARGET_DIR", self.folder.join("host").as_os_str())],
        )
    }
}

/// The cargo arguments that select the firmware's tests.
const FIRMWARE_TESTS: &str = "-p lizard-host-tests --test firmware --test trouble";

/// Compiles the firmware's tests, which no mutant changes, so that the limits of [`run_cargo_test`] are for their run
/// alone.
fn compile_firmware_tests() -> Result<(), String> {
    let status = Command::new("cargo")
        .args(["test", "--quiet", "--no-run"])
        .args(FIRMWARE_TESTS.split(' '))
        .current_dir(root().join("crates"))
        .status()
        .map_err(|error| format!("cargo: {error}"))?;
    match status.success() {
        true => Ok(()),
        false => Err("the tests of the firmware do not compile".into()),
    }
}

/// Runs the firmware's tests whose names contain `filter`. Returns the names of the failed tests; `None` if the tests
/// hang.
fn run_firmware_tests(elf: &Path, filter: &str) -> Result<Option<Vec<String>>, String> {
    let arguments = format!("{FIRMWARE_TESTS} -- {filter}");
    let result = run_cargo_test(
        &root().join("crates"),
        &arguments.split(' ').collect::<Vec<_>>(),
        // Five times the default number of random inputs.
        &[
            ("LIZARD_ELF", elf.as_os_str()),
            ("LIZARD_FUZZ", "5".as_ref()),
        ],
    )?;
    let Some((have_passed, output_text)) = result else {
        return Ok(None);
    };
    if !output_text.contains("running ") {
        return Err("the tests of the firmware did not run; run make test to see the error".into());
    }
    if have_passed && !has_run_a_test(&output_text) {
        return Err(format!(
            "no test of the firmware has {filter:?} in its name"
        ));
    }
    let failed_tests = find_failed_tests(&output_text);
    // If no test has failed, one of the two test programs has reached the limit of processor time, or has crashed.
    let is_hanging = !have_passed && failed_tests.is_empty();
    Ok((!is_hanging).then_some(failed_tests))
}

/// Runs `cargo test` in a folder. Returns true if the tests passed, and their output; `None` if the tests do not end
/// within [`TIMEOUT_S`].
fn run_cargo_test(
    folder: &Path,
    arguments: &[&str],
    variables: &[(&str, &OsStr)],
) -> Result<Option<(bool, String)>, String> {
    /// The exit code of `timeout` after a time-out, when it also ends the tests that cargo has started.
    const TIMEOUT_CODE: i32 = 124;
    let output = Command::new("prlimit")
        .arg(format!("--cpu={CPU_TIMEOUT_S}"))
        .args(["timeout", "--kill-after=5", &TIMEOUT_S.to_string()])
        .args(["cargo", "test"])
        .args(arguments)
        .current_dir(folder)
        .env("PROPTEST_RNG_SEED", "1")
        .env("RUST_BACKTRACE", "0")
        .envs(variables.iter().copied())
        .stderr(Stdio::null())
        .output()
        .map_err(|error| format!("cargo: {error}"))?;
    let output_text = String::from_utf8_lossy(&output.stdout).into_owned();
    let has_ended = output.status.code() != Some(TIMEOUT_CODE);
    Ok(has_ended.then_some((output.status.success(), output_text)))
}

/// True if at least one test has run, according to the output of the test harness.
fn has_run_a_test(output_text: &str) -> bool {
    // The summary, which begins with `test result: `, is not the line of a test.
    let is_test_line = |line: &str| line.starts_with("test ") && line.contains(" ... ");
    output_text.lines().any(is_test_line)
}

/// Finds the names of the failed tests in the output of the test harness.
fn find_failed_tests(output_text: &str) -> Vec<String> {
    let failed_name = |line: &str| {
        let name = line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?;
        Some(name.to_owned())
    };
    output_text.lines().filter_map(failed_name).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_old_texts_of_all_listed_mutants_are_current() {
        let list = super::read_list().expect("the list is current");
        assert!(list.len() > 50, "only {} mutants are listed", list.len());
    }

    #[test]
    fn a_summary_line_does_not_count_as_a_test() {
        let summary = "running 0 tests\n\ntest result: ok. 0 passed; 0 failed\n";
        assert!(!super::has_run_a_test(summary));
        assert!(super::has_run_a_test("running 1 test\ntest walks ... ok\n"));
    }

    #[test]
    #[cfg(unix)]
    fn the_linker_of_the_copy_is_executable() {
        use std::os::unix::fs::PermissionsExt;
        let scratch = super::ScratchTree::copy().expect("the tree is copied");
        let linker = scratch.folder.join("tree/scripts/link");
        let permissions = linker.metadata().expect("the linker exists").permissions();
        assert_ne!(permissions.mode() & 0o111, 0, "{:o}", permissions.mode());
    }
}
