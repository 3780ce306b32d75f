//! The format of a model's file, chosen by the ending of the file's name.

use std::path::Path;

use crate::Failure;

/// The format of a model's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// MuJoCo's format.
    Mjcf,
    /// The format of ROS, without closed loops.
    Urdf,
    /// Gazebo's format.
    Sdf,
}

impl Format {
    /// The format of a file, by the ending of its name. A file without an ending, such as /dev/stdout, gets MuJoCo's
    /// format, the only one that has everything in one file.
    ///
    /// # Errors
    /// Fails for any other ending.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        let ending = path
            .extension()
            .map(|end| end.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            None | Some("xml" | "mjcf") => Ok(Self::Mjcf),
            Some("urdf") => Ok(Self::Urdf),
            Some("sdf") => Ok(Self::Sdf),
            Some(_) => Err(Failure::Input(format!(
                "{}: the ending decides the format; it is .xml for MuJoCo, .urdf for ROS, .sdf for Gazebo",
                path.display()
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_decides_the_format() {
        for (path, format) in [
            ("out/a.xml", Format::Mjcf),
            ("/dev/stdout", Format::Mjcf),
            ("a.b/robot", Format::Mjcf),
            ("a.xml.URDF", Format::Urdf),
            ("a.sdf", Format::Sdf),
        ] {
            assert_eq!(Format::of(Path::new(path)).expect(path), format, "{path}");
        }
        let refusal = Format::of(Path::new("out/a.urfd")).expect_err("the ending is misspelt");
        assert!(refusal.to_string().starts_with("out/a.urfd: "), "{refusal}");
    }
}
