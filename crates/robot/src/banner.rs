//! The firmware's banner, its first line after a reset.

/// The name and the hash by which a board identifies its robot.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RobotIdentity {
    /// The robot's name in robot.toml.
    pub name: String,
    /// The hash of the robot's parameters as stored in the flash, eight lower-case hexadecimal digits.
    pub hash: String,
}

impl RobotIdentity {
    /// Returns the identity that a board will report for a robot.
    #[must_use]
    pub fn for_robot(robot: &lizard_core::numbers::robot::Robot) -> Self {
        let name = robot.name().map(char::from).collect();
        let hash = format!("{:08x}", robot.hash());
        Self { name, hash }
    }
}

/// The contents of a banner: the firmware and the robot on a board.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Banner {
    /// The firmware's version.
    pub version: String,
    /// The robot in the flash; `None` if the robot is missing or damaged.
    pub robot: Option<RobotIdentity>,
}

impl Banner {
    /// Parses a banner; `None` for any other line, including a truncated banner and the banner of older firmware, into
    /// which the robot was compiled.
    #[must_use]
    pub fn parse(line: &str) -> Option<Self> {
        let (line, _) = line.strip_prefix("# lizard ")?.split_once(',')?;
        let (version, rest) = line.split_once(' ')?;
        let words: Vec<&str> = rest.split(' ').collect();
        let robot = match words[..] {
            ["robot", name, hash] if !name.is_empty() && is_hash(hash) => Some(RobotIdentity {
                name: name.to_owned(),
                hash: hash.to_owned(),
            }),
            ["without", "a", "robot"] => None,
            _ => return None,
        };
        Some(Self {
            version: version.to_owned(),
            robot,
        })
    }
}

/// True if a text consists of eight lower-case hexadecimal digits.
fn is_hash(text: &str) -> bool {
    text.len() == 8 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_banner_names_the_firmware_and_its_robot_if_there_is_one() {
        let paper = RobotIdentity {
            name: "paper".to_owned(),
            hash: "1a2b3c4d".to_owned(),
        };
        for (words, robot) in [
            ("robot paper 1a2b3c4d", Some(paper)),
            ("without a robot", None),
        ] {
            let line = format!("# lizard 0.2.0 {words}, send help for the commands");
            let banner = Banner::parse(&line).expect("the line is a banner");
            assert_eq!((banner.version.as_str(), banner.robot), ("0.2.0", robot));
        }
    }

    #[test]
    fn other_lines_and_truncated_banners_are_rejected() {
        for line in [
            "hello",
            "# lizard ",
            "# lizard 0.2.0",
            "# lizard 0.1.0, send help for the commands",
            "# lizard 0.2.0 robot paper 1a2b",
            "# lizard 0.2.0 robot paper, send help for the commands",
            "# lizard 0.2.0 robot paper 1a2b, send help for the commands",
            "# lizard 0.2.0 robot paper 1A2B3C4X, send help for the commands",
            "# lizard 0.2.0 robot  1a2b3c4d, send help for the commands",
        ] {
            assert_eq!(Banner::parse(line), None, "{line}");
        }
    }
}
