//! Functions that read and write files for all commands.
//!
//! A program that is killed during a write leaves an incomplete file, and an incomplete image or calibration is worse
//! than a missing file. The bytes are therefore first written to a file without a name, or to a temporary file if the
//! file system does not support nameless files. The file gets its final name when it is complete.
//!
//! An output replaces only a regular file, because other programs need devices such as /dev/null. An output never
//! replaces an input of the same command or a robot file, except a robot file that this command has written and nobody
//! has edited: a mistyped name must not destroy a user's work.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::Failure;

/// The advice for `-` as an output, which many programs take for standard output.
const HYPHEN_ADVICE: &str = "- is not an output file; write ./- for a file of this name";

/// The files that this command has read.
static INPUT_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Records an input file before it is read, so that no output replaces the file.
pub fn record_input(path: &Path) -> &Path {
    let mut inputs = INPUT_FILES.lock().unwrap_or_else(PoisonError::into_inner);
    inputs.push(path.to_owned());
    path
}

/// Reads the text of an input file: UTF-8, or UTF-16 as PowerShell's `>` writes it. Skips a byte order mark.
///
/// # Errors
/// Fails if the file cannot be read, is not such a text, or is longer than 256 MiB, as an endless device is.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    const MAX_BYTES: u64 = 256 << 20;
    let mut bytes = Vec::new();
    let outcome = File::open(record_input(path)).and_then(|file| {
        match file.take(MAX_BYTES + 1).read_to_end(&mut bytes)? as u64 {
            0..=MAX_BYTES => decode_text(bytes)
                .ok_or_else(|| io::Error::other("it is not UTF-8 text; save it as UTF-8")),
            _ => Err(io::Error::other("the file is longer than 256 MiB")),
        }
    });
    outcome.map_err(|error| Failure::Input(format!("cannot read {}: {error}", path.display())))
}

/// Decodes UTF-8, or UTF-16 with the byte order mark FF FE; removes a byte order mark. Returns `None` for other bytes.
fn decode_text(bytes: Vec<u8>) -> Option<String> {
    let Some(utf16_bytes) = bytes.strip_prefix(&[0xff, 0xfe]) else {
        let text = String::from_utf8(bytes).ok()?;
        let without_mark = text.strip_prefix('\u{feff}').map(str::to_owned);
        return Some(without_mark.unwrap_or(text));
    };
    let (units, rest) = utf16_bytes.as_chunks();
    let units: Vec<u16> = units.iter().copied().map(u16::from_le_bytes).collect();
    String::from_utf16(&units).ok().filter(|_| rest.is_empty())
}

/// Checks that an output may be written to `path`.
///
/// # Errors
/// Fails if the output would replace an input or a robot file, if a file has the path of its folder, and for `-`.
pub fn check_replaceable(path: &Path) -> Result<(), Failure> {
    check_replaceable_robot(path, |_| false)
}

/// Checks as [`check_replaceable`] does, but also accepts a robot file that is an earlier output of the same command:
/// its text satisfies `is_own_output`, and it is not called robot.toml.
///
/// # Errors
/// Fails as [`check_replaceable`] does.
pub fn check_replaceable_robot(
    path: &Path,
    is_own_output: impl Fn(&str) -> bool,
) -> Result<(), Failure> {
    if path == Path::new("-") {
        return Err(Failure::Input(format!("{HYPHEN_ADVICE}, or /dev/stdout")));
    }
    check_folder(parent_folder(path))?;
    let inputs = INPUT_FILES.lock().unwrap_or_else(PoisonError::into_inner);
    let is_input = |input: &PathBuf| same_file::is_same_file(input, path).unwrap_or(false);
    let reason = if inputs.iter().any(is_input) {
        "this command reads it"
    } else if is_robot_file(path, is_own_output) {
        "it describes a robot"
    } else {
        return Ok(());
    };
    Err(Failure::Input(format!(
        "the output must not overwrite {}: {reason}; choose another output file",
        path.display()
    )))
}

/// Checks that an output without a file does not go to a terminal. The message says what is written (`noun`)
/// and suggests a file name (`example`).
///
/// # Errors
/// Fails if there is no file and standard output is a terminal.
pub fn check_no_terminal(output: Option<&Path>, noun: &str, example: &str) -> Result<(), Failure> {
    if output.is_none() && io::stdout().is_terminal() {
        return Err(Failure::Input(format!(
            "standard output is a terminal; write the {noun} to a file with --output {example}"
        )));
    }
    Ok(())
}

/// Checks that no file has the path of an output folder, or of a folder above it. A long command checks this first.
///
/// # Errors
/// Fails if there is such a file.
pub fn check_folder(folder: &Path) -> Result<(), Failure> {
    if folder.ancestors().any(Path::is_file) {
        let error = io::Error::from(ErrorKind::AlreadyExists);
        return Err(write_failure(folder, &error));
    }
    Ok(())
}

/// True for a file that is called robot.toml or has a robot's table `[links]`, even if the rest of the file is
/// invalid. False for another name and a text that satisfies `is_own_output`.
fn is_robot_file(path: &Path, is_own_output: impl Fn(&str) -> bool) -> bool {
    if !path.is_file() {
        return false;
    }
    let Ok(resolved_path) = path.canonicalize() else {
        return false;
    };
    let describes_robot = |bytes: Vec<u8>| {
        let text = String::from_utf8_lossy(&bytes);
        let has_links_table = text.lines().any(|line| line.trim().starts_with("[links]"));
        has_links_table && !is_own_output(&text)
    };
    resolved_path.ends_with("robot.toml") || fs::read(resolved_path).is_ok_and(describes_robot)
}

/// Writes a file completely or not at all, and creates missing folders. Replaces an existing file, also through a
/// symbolic link, and keeps its permissions. Writes directly to a stream, such as /dev/stdout or a pipe.
///
/// # Errors
/// Fails if the folder cannot be created or written to, if the path names neither a regular file nor a stream (for
/// example, a folder), or if the file is an input or a robot ([`check_replaceable`]).
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write_robot(path, bytes, |_| false)
}

/// Writes a file as [`write`] does, but also replaces a robot file that is an earlier output of the same command, as
/// [`check_replaceable_robot`] describes. Checks this again, because the user may have edited the file since.
///
/// # Errors
/// Fails as [`write`] does, except for such an earlier output.
pub fn write_robot(
    path: &Path,
    bytes: &[u8],
    is_own_output: impl Fn(&str) -> bool,
) -> Result<(), Failure> {
    check_replaceable_robot(path, is_own_output)?;
    let outcome = if is_standard_output(path) {
        // Standard output may be a file with other contents, so it is neither opened again nor replaced.
        let mut out = io::stdout().lock();
        out.write_all(bytes).and_then(|()| out.flush())
    } else if is_stream(path) {
        // Opens the stream without creating or truncating a file.
        File::options()
            .write(true)
            .open(path)
            .and_then(|mut stream| stream.write_all(bytes))
    } else {
        fs::create_dir_all(parent_folder(path)).and_then(|()| write_atomically(path, bytes))
    };
    outcome.map_err(|error| write_failure(path, &error))
}

/// Creates a new file. `advice` completes the message about an existing file.
///
/// # Errors
/// Fails if the file already exists, or cannot be created, and for `-`.
pub fn create_new(path: &Path, advice: &str) -> Result<File, Failure> {
    if path == Path::new("-") {
        return Err(Failure::Input(HYPHEN_ADVICE.to_owned()));
    }
    File::create_new(path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            Failure::Input(format!("{} already exists; {advice}", path.display()))
        }
        _ => write_failure(path, &error),
    })
}

/// Returns the failure for a path that cannot be written.
pub fn write_failure(path: &Path, error: &io::Error) -> Failure {
    let reason = match error.kind() {
        ErrorKind::AlreadyExists => "a file exists where a folder is needed".to_owned(),
        _ => error.to_string(),
    };
    // tempfile appends the path of the temporary file, which means nothing to the user.
    let reason = reason
        .split_once(" at path ")
        .map_or(reason.as_str(), |(reason, _)| reason);
    Failure::Operation(format!("cannot write {}: {reason}", path.display()))
}

/// True if an output goes to standard output, which must then contain no message.
pub fn is_standard_output(path: &Path) -> bool {
    path == Path::new("/dev/stdout")
}

/// Returns the folder that contains a file.
fn parent_folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// True for a character device or a named pipe.
#[cfg(unix)]
fn is_stream(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    path.metadata()
        .map(|metadata| metadata.file_type())
        .is_ok_and(|file_type| file_type.is_char_device() || file_type.is_fifo())
}

#[cfg(not(unix))]
fn is_stream(_: &Path) -> bool {
    false
}

/// Follows the symbolic links of a path. Returns the path of the file itself, and its permissions if it exists.
fn resolve_links(path: &Path) -> io::Result<(PathBuf, Option<Permissions>)> {
    match path.metadata() {
        Ok(metadata) if metadata.is_file() => {
            Ok((path.canonicalize()?, Some(metadata.permissions())))
        }
        Ok(_) => Err(io::Error::other(
            "it already exists and is not a regular file",
        )),
        Err(_) if path.is_symlink() => Err(io::Error::other("it is a broken symbolic link")),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok((path.to_owned(), None)),
        Err(error) => Err(error),
    }
}

/// Writes the bytes to a nameless or temporary file in the target's folder, and then gives that file its final path.
fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let (path, permissions) = resolve_links(path)?;
    let folder = parent_folder(&path);
    let write_content = |file: &mut File| {
        file.write_all(bytes)?;
        if let Some(permissions) = permissions {
            file.set_permissions(permissions)?;
        }
        file.sync_all()
    };
    #[cfg(target_os = "linux")]
    if let Some(mut file) = create_nameless(folder) {
        write_content(&mut file)?;
        let link_file = |name: &Path| link_to_name(&file, name);
        tempfile::Builder::new()
            .make_in(folder, link_file)?
            .persist(path)?;
        return Ok(());
    }
    #[cfg_attr(
        not(unix),
        expect(unused_mut, reason = "Windows has no such permissions")
    )]
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The permissions of any new file; the user's umask restricts them.
        builder.permissions(Permissions::from_mode(0o666));
    }
    // The temporary file is in the same folder, because a move is atomic only within a file system.
    let mut file = builder.tempfile_in(folder)?;
    write_content(file.as_file_mut())?;
    file.persist(path)?;
    Ok(())
}

/// Creates a file without a name in `folder`; it disappears if the program is killed. Returns `None` if the file system
/// does not support nameless files.
#[cfg(target_os = "linux")]
fn create_nameless(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    let file = open(folder, flags, Mode::from_raw_mode(0o666)).ok()?;
    // A nameless file can be given a name only through /proc/self/fd.
    Path::new("/proc/self/fd").is_dir().then(|| file.into())
}

/// Gives a name to a file that [`create_nameless`] created.
#[cfg(target_os = "linux")]
fn link_to_name(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let fd_path = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, fd_path, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failure_message(path: &Path) -> String {
        write(path, b"x")
            .expect_err("the write must be refused")
            .to_string()
    }

    #[test]
    fn write_replaces_a_file_and_leaves_no_other() {
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        let path = folder.path().join("new/folder/a");
        write(&path, b"old and longer").expect("a new file is written");
        write(&path, &[0, 0xff]).expect("an existing file is replaced");
        assert_eq!(fs::read(&path).expect("the file is readable"), [0, 0xff]);
        let folder = path.parent().expect("the file is in a folder");
        assert_eq!(
            folder.read_dir().expect("the folder is readable").count(),
            1
        );
    }

    #[test]
    fn write_refuses_inputs_and_robot_files_under_any_name() {
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        let [input, other_name, robot, renamed_robot] =
            ["a.jsonl", "b", "robot.toml", "mine"].map(|name| folder.path().join(name));
        fs::write(&input, "an input").expect("the file is written");
        fs::write(&robot, "broken").expect("the file is written");
        fs::write(&renamed_robot, "# mine\n [links]\nl0 = x\n").expect("the file is written");
        fs::hard_link(&input, &other_name).expect("a hard link is created");
        let _ = record_input(&folder.path().join("../").join(&input));
        for (path, reason) in [
            (&input, ": this command reads it; choose another"),
            (&other_name, ": this command reads it; choose another"),
            (&robot, ": it describes a robot; choose another"),
            (&renamed_robot, ": it describes a robot; choose another"),
        ] {
            let old_bytes = fs::read(path).expect("the file is readable");
            let message = failure_message(path);
            assert!(message.contains(reason), "{message}");
            assert_eq!(fs::read(path).expect("the file is readable"), old_bytes);
        }
        write(&folder.path().join("c"), b"x").expect("any other file is written");
        let is_mine = |text: &str| text.starts_with("# mine");
        for (path, is_replaceable) in [(&robot, false), (&renamed_robot, true), (&input, false)] {
            let result = check_replaceable_robot(path, is_mine);
            assert_eq!(result.is_ok(), is_replaceable, "{}", path.display());
        }
        // The user edits an earlier output during the command, after its first check.
        let write_output = || write_robot(&renamed_robot, b"[links]", is_mine);
        write_output().expect("an earlier output is replaced");
        write_output().expect_err("an edited output must be kept");
        let message = failure_message(&renamed_robot.join("folder/d"));
        assert!(message.ends_with("mine/folder: a file exists where a folder is needed"));
    }

    #[test]
    fn read_text_accepts_the_encodings_that_windows_programs_write() {
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        let path = folder.path().join("a.json");
        let read = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("the file is written");
            read_text(&path).map_err(|failure| failure.to_string())
        };
        let utf16_bytes = b"\xff\xfe{\0\xe4\0}\0";
        for bytes in [&b"{\xc3\xa4}"[..], b"\xef\xbb\xbf{\xc3\xa4}", utf16_bytes] {
            assert_eq!(read(bytes), Ok("{\u{e4}}".to_owned()), "{bytes:?}");
        }
        for bytes in [&b"\xe4"[..], b"\xff\xfe{", b"\xff\xfe\0\xd8"] {
            let result = read(bytes);
            assert!(result.is_err_and(|message| message.ends_with("; save it as UTF-8")));
        }
    }

    #[test]
    fn the_error_names_the_unwritable_file() {
        for (path, reason) in [
            ("/dev/null/folder/a.toml", "Not a directory (os error 20)"),
            ("/dev/null/a.toml", "a file exists where a folder is needed"),
        ] {
            let message = failure_message(Path::new(path));
            assert_eq!(message, format!("cannot write {path}: {reason}"));
        }
    }

    #[test]
    fn write_refuses_a_folder() {
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        let inner_folder = folder.path().join("inner");
        fs::create_dir(&inner_folder).expect("a folder is created");
        assert!(
            failure_message(&inner_folder).ends_with("it already exists and is not a regular file")
        );
        assert!(inner_folder.is_dir());
    }

    #[test]
    #[cfg(unix)]
    fn write_through_a_link_keeps_the_link_and_the_permissions() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        let [file, link, broken_link] =
            ["file", "link", "astray"].map(|name| folder.path().join(name));
        fs::write(&file, "old").expect("the file is written");
        fs::set_permissions(&file, Permissions::from_mode(0o640))
            .expect("the owner may set permissions");
        symlink("file", &link).expect("a link is created");
        write(&link, b"new").expect("the file is written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).expect("the file is readable"), b"new");
        let mode = file
            .metadata()
            .expect("the file exists")
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o640);
        symlink("nothing", &broken_link).expect("a link is created");
        assert!(failure_message(&broken_link).ends_with("astray: it is a broken symbolic link"));
        assert!(broken_link.is_symlink());
    }

    #[test]
    #[cfg(unix)]
    fn write_to_a_stream_keeps_the_stream() {
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        // The test uses a link, so that a bug replaces the link and not the device.
        let device = folder.path().join("device");
        std::os::unix::fs::symlink("/dev/null", &device).expect("a link is created");
        write(&device, b"<svg/>").expect("/dev/null accepts all bytes");
        assert!(device.is_symlink());
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_error_names_only_the_file_in_a_read_only_folder_or_on_a_full_device() {
        for (path, reason) in [("/proc/self/a.toml", ""), ("/dev/full", "No space left")] {
            let message = failure_message(Path::new(path));
            let start = format!("cannot write {path}: {reason}");
            assert!(message.starts_with(&start), "{message}");
            assert!(!message.contains("at path"), "{message}");
        }
    }
}
