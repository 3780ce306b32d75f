//! A file that is written whole or not at all.
//!
//! A program that is ended while it writes leaves half a file, and half an image or
//! half a calibration is worse than none. So the bytes go into a temporary file beside
//! it, which takes its name at the end.

use std::io::{self, Write};
use std::path::Path;

use crate::Failure;

/// Writes a file whole or not at all; one that is there is replaced.
///
/// # Errors
/// The folder is missing or cannot be written to; or there is something at this path that is
/// no ordinary file, such as a device or a folder: it would be replaced by a file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    persist(path, bytes)
        .map_err(|error| Failure::Impossible(format!("cannot write {}: {error}", path.display())))
}

fn persist(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|it| !it.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(io::Error::other("there is no such folder"));
    }
    if path.metadata().is_ok_and(|there| !there.is_file()) {
        return Err(io::Error::other("it is there already and no ordinary file"));
    }
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any other file: the user's umask takes its part away.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // In the same folder: a file moves into its place at once only there.
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
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
        assert_eq!(std::fs::read(&path).expect("it is read"), [0, 0xff]);
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
        std::fs::create_dir(&inner).expect("a folder in it");
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
}
