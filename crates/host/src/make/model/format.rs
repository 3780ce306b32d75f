//! The format of a model's file, determined by the file extension.

use std::path::Path;

use crate::Failure;

/// The format of a model's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ModelFormat {
    /// MuJoCo's format.
    Mjcf,
    /// The format of ROS, without closed loops.
    Urdf,
    /// Gazebo's format.
    Sdf,
}

impl ModelFormat {
    /// Returns the format for a file's extension. A file without an extension, such as /dev/stdout, gets MuJoCo's
    /// format, the only format with a single file.
    ///
    /// # Errors
    /// Fails for any other extension.
    pub fn from_path(path: &Path) -> Result<Self, Failure> {
        let extension = path
            .extension()
            .map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            None | Some("xml" | "mjcf") => Ok(Self::Mjcf),
            Some("urdf") => Ok(Self::Urdf),
            Some("sdf") => Ok(Self::Sdf),
            Some(_) => Err(Failure::Input(format!(
                "{}: unknown file extension; allowed values: .xml (MuJoCo), .urdf (ROS), .sdf (Gazebo)",
                path.display()
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_extension_determines_the_format() {
        for (path, format) in [
            ("out/a.xml", ModelFormat::Mjcf),
            ("/dev/stdout", ModelFormat::Mjcf),
            ("a.b/robot", ModelFormat::Mjcf),
            ("a.xml.URDF", ModelFormat::Urdf),
            ("a.sdf", ModelFormat::Sdf),
        ] {
            let result = ModelFormat::from_path(Path::new(path));
            assert_eq!(result.expect(path), format, "{path}");
        }
        let refusal = ModelFormat::from_path(Path::new("out/a.urfd"))
            .expect_err("an unknown extension must be refused");
        assert!(refusal.to_string().starts_with("out/a.urfd: "), "{refusal}");
    }
}
