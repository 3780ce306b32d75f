//! A file that is written completely or not at all.
//!
//! A program that is ended while it writes leaves half a file, and half an image or
//! half a calibration is worse than none. So the bytes go into a temporary file beside
//! it, which takes its name at the end.
//!
//! A file may replace only an ordinary file. If it replaced a device such as /dev/null,
//! every program of the machine would get it.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::Failure;

/// Writes a file whole or not at all; one that is there is replaced, also where a link
/// leads to it, and keeps its permissions.
///
/// # Errors
/// The folder is missing or cannot be written to; or there is something at this path that is
/// no ordinary file, such as a device or a folder: it would be replaced by a file.
#[cfg(any(test, feature = "console", feature = "paper"))]
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    persist(path, bytes).map_err(|error| cannot(path, &error))
}

/// As [`write`], for what is to be looked at: makes the folders it needs, and what is
/// a stream, such as /dev/stdout or a named pipe, gets the bytes.
///
/// # Errors
/// As [`write`], but for streams.
pub fn write_picture(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let done = if is_stream(path) {
        // As it is: nothing is made, nothing is cut.
        File::options()
            .write(true)
            .open(path)
            .and_then(|mut stream| stream.write_all(bytes))
    } else {
        folders(path).and_then(|()| persist(path, bytes))
    };
    done.map_err(|error| cannot(path, &error))
}

/// The sentence for a path that cannot be written.
pub fn cannot(path: &Path, error: &io::Error) -> Failure {
    let why = error.to_string();
    // tempfile adds the name of the temporary file, which means nothing to a user.
    let why = why
        .split_once(" at path ")
        .map_or(why.as_str(), |(why, _)| why);
    Failure::Impossible(format!("cannot write {}: {why}", path.display()))
}

fn folders(path: &Path) -> io::Result<()> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => fs::create_dir_all(folder),
        _ => Ok(()),
    }
}

#[cfg(unix)]
fn is_stream(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    path.metadata()
        .map(|there| there.file_type())
        .is_ok_and(|kind| kind.is_char_device() || kind.is_fifo())
}

#[cfg(not(unix))]
fn is_stream(_: &Path) -> bool {
    false
}

/// Where the file is: the end of the links, if the path is one. And its permissions, if it
/// is there.
fn place(path: &Path) -> io::Result<(PathBuf, Option<Permissions>)> {
    match path.metadata() {
        Ok(there) if there.is_file() => Ok((path.canonicalize()?, Some(there.permissions()))),
        Ok(_) => Err(io::Error::other("it is there already and no ordinary file")),
        Err(_) if path.is_symlink() => Err(io::Error::other("it is a link that leads nowhere")),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok((path.to_owned(), None)),
        Err(error) => Err(error),
    }
}

fn persist(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder_of = |path: &Path| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    if !folder_of(path).is_dir() {
        return Err(io::Error::other("there is no such folder"));
    }
    let (path, permissions) = place(path)?;
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any other file: the user's umask takes its part away.
        builder.permissions(Permissions::from_mode(0o666));
    }
    // In the same folder: a file moves into its place at once only there.
    let mut file = builder.tempfile_in(folder_of(&path))?;
    file.write_all(bytes)?;
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions)?;
    }
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(path: &Path) -> String {
        write(path, b"x")
            .expect_err("it is not written")
            .to_string()
    }

    #[test]
    fn a_file_is_replaced_and_nothing_else_is_left_in_its_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a");
        write(&path, b"old and longer").expect("it is written");
        write(&path, &[0, 0xff]).expect("it is replaced");
        assert_eq!(fs::read(&path).expect("it is read"), [0, 0xff]);
        assert_eq!(folder.path().read_dir().expect("a folder").count(), 1);
    }

    #[test]
    fn a_file_that_cannot_be_written_is_named() {
        assert_eq!(
            refusal(Path::new("/no/such/folder/a.toml")),
            "cannot write /no/such/folder/a.toml: there is no such folder"
        );
    }

    #[test]
    fn a_folder_and_a_device_are_not_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("inner");
        fs::create_dir(&inner).expect("a folder in it");
        assert!(refusal(&inner).ends_with("it is there already and no ordinary file"));
        assert!(inner.is_dir());
        // A link, so that a mistake here would not harm the machine.
        #[cfg(unix)]
        {
            let device = folder.path().join("device");
            std::os::unix::fs::symlink("/dev/null", &device).expect("a link");
            assert!(refusal(&device).ends_with("it is there already and no ordinary file"));
            assert!(device.is_symlink());
        }
    }

    #[test]
    #[cfg(unix)]
    fn a_link_stays_one_and_the_file_at_its_end_is_replaced_with_its_permissions() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let [file, link, astray] = ["file", "link", "astray"].map(|name| folder.path().join(name));
        fs::write(&file, "old").expect("it is written");
        fs::set_permissions(&file, Permissions::from_mode(0o640)).expect("it is ours");
        symlink("file", &link).expect("a link");
        write(&link, b"new").expect("it is written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).expect("it is read"), b"new");
        let mode = file.metadata().expect("it is there").permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
        symlink("nothing", &astray).expect("a link");
        assert!(refusal(&astray).ends_with("astray: it is a link that leads nowhere"));
        assert!(astray.is_symlink());
    }

    #[test]
    #[cfg(unix)]
    fn a_picture_goes_into_a_stream_and_the_stream_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        // A link, so that a mistake here would not harm the machine.
        let device = folder.path().join("device");
        std::os::unix::fs::symlink("/dev/null", &device).expect("a link");
        write_picture(&device, b"<svg/>").expect("it takes everything");
        assert!(device.is_symlink());
        let inner = folder.path().join("new/folder/a.svg");
        write_picture(&inner, b"<svg/>").expect("its folders are made");
        assert_eq!(fs::read(&inner).expect("it is read"), b"<svg/>");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn of_a_folder_that_takes_no_files_the_file_alone_is_named() {
        let words = refusal(Path::new("/proc/self/a.toml"));
        assert!(
            words.starts_with("cannot write /proc/self/a.toml: "),
            "{words}"
        );
        assert!(!words.contains("at path"), "{words}");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_device_is_named() {
        let words = write_picture(Path::new("/dev/full"), b"<svg/>").expect_err("it is full");
        let words = words.to_string();
        assert!(
            words.starts_with("cannot write /dev/full: No space left"),
            "{words}"
        );
    }
}
