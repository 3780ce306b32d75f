//! The contents of a board's flash before it is written.
//!
//! Writing destroys the old contents, and the user may have chosen the wrong board, so the contents are reported
//! first. The firmware does not run during an upload and cannot be asked, so they are read from flash.

use std::fmt;

use lizard_core::numbers::mark::Mark;
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::section::{Region, START_ADDRESS};

use crate::image::{BLANK, Image, PAGE_BYTES, Page};

/// The code at address 0 during an upload, with nothing else in its page: `rjmp .-2`, a jump to itself.
pub(super) const IDLE_JUMP: [u8; 2] = [0xff, 0xcf];

/// The address of a robot's section in flash.
const ROBOT_ADDRESS: usize = START_ADDRESS as usize;

/// The contents of a board's flash, compared with an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlashContents {
    /// The program in flash.
    pub program: Program,
    /// The robot's section after the code. Only lizard firmware uses it.
    pub robot: RobotInFlash,
    /// True if flash holds the image already.
    pub has_image: bool,
}

/// The program in a board's flash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// No program, as on a new chip.
    Blank,
    /// An incomplete program, which does nothing: an upload was not finished.
    Incomplete,
    /// The firmware of a lizard.
    Lizard {
        /// The version mark in the code.
        mark: Mark,
        /// True if the code differs from the code of the image, even if the versions are equal.
        is_different: bool,
    },
    /// A program that is not lizard firmware.
    Other {
        /// The size in bytes up to the last one that is not blank; `None` if only the first page was read.
        bytes: Option<usize>,
    },
}

/// The robot's section in a board's flash.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RobotInFlash {
    /// The section is blank.
    Blank,
    /// A valid robot, by its name and hash.
    Named(String),
    /// A section that was not completely written, is damaged, or has another format.
    Damaged,
}

impl FlashContents {
    /// Compares `flash`, from address 0 to the boot loader, with an image. If the image is a robot
    /// alone, only the first page and the robot's pages of `flash` need to be valid.
    pub fn compare(flash: &[u8], image: &Image) -> Self {
        let pages = image.pages();
        let is_in_flash = |page: &&Page| flash[page.range()] == page.bytes;
        let code_pages = pages.iter().filter(|page| page.address < ROBOT_ADDRESS);
        let program = match Mark::find(flash) {
            Some(mark) => Program::Lizard {
                mark,
                is_different: !code_pages.clone().all(|page| is_in_flash(&page)),
            },
            None if flash[..2] == IDLE_JUMP && is_blank(&flash[2..PAGE_BYTES]) => {
                Program::Incomplete
            }
            None if image.is_robot_alone() && is_blank(&flash[..PAGE_BYTES]) => Program::Blank,
            None if image.is_robot_alone() => Program::Other { bytes: None },
            None => match flash.iter().rposition(|&byte| byte != BLANK) {
                None => Program::Blank,
                Some(last_address) => Program::Other {
                    bytes: Some(last_address + 1),
                },
            },
        };
        // Other programs do not use the robot's section, so only lizard firmware with this section has the image.
        let has_code = matches!(program, Program::Lizard { .. }) || !image.is_robot_alone();
        let has_image = has_code && pages.iter().all(|page| is_in_flash(&page));
        let robot = match robot_in(flash) {
            Some(robot) => RobotInFlash::Named(robot_label(&robot)),
            None if is_blank(&flash[ROBOT_ADDRESS..ROBOT_ADDRESS + PAGE_BYTES]) => {
                RobotInFlash::Blank
            }
            None => RobotInFlash::Damaged,
        };
        Self {
            program,
            robot,
            has_image,
        }
    }
}

/// A robot's name and hash, as printed in the firmware's banner.
pub fn robot_label(robot: &Robot) -> String {
    let name: String = robot.robot_name().map(char::from).collect();
    format!("{name} {:08x}", robot.hash())
}

/// The robot in the contents of flash, which start at address 0; `None` if there is no valid robot.
pub fn robot_in(flash: &[u8]) -> Option<Robot<'_>> {
    Robot::open(Region::new(flash.get(ROBOT_ADDRESS..)?)).ok()
}

fn is_blank(bytes: &[u8]) -> bool {
    bytes.iter().all(|&byte| byte == BLANK)
}

impl fmt::Display for FlashContents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the board has ")?;
        match self.program {
            Program::Blank => f.write_str("no program")?,
            Program::Incomplete => f.write_str("half a program, which does nothing")?,
            Program::Other { .. } if self.has_image => f.write_str("this program")?,
            Program::Other { bytes: None } => f.write_str("another program")?,
            Program::Other { bytes: Some(bytes) } => {
                write!(f, "another program, of {bytes} bytes")?;
            }
            Program::Lizard { mark, is_different } => {
                let [major, minor, patch] = mark.version;
                if is_different && mark == Mark::THIS_FIRMWARE {
                    f.write_str("another build of ")?;
                }
                write!(f, "lizard {major}.{minor}.{patch}")?;
                match &self.robot {
                    RobotInFlash::Blank => f.write_str(" without a robot")?,
                    RobotInFlash::Damaged => f.write_str(" with a damaged robot")?,
                    RobotInFlash::Named(name) => write!(f, " robot {name}")?,
                }
            }
        }
        f.write_str(if self.has_image { " already" } else { "" })
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;
    use crate::image::BOOT_ADDRESS;
    use crate::upload::tests::{CODE, robot};

    #[test]
    fn blank_flash_half_a_program_and_another_program_are_distinguished() {
        let image = Image::new(vec![1, 2, 3]).expect("the image fits");
        let description_after = |changes: &[(usize, u8)]| {
            let mut flash = vec![0xff; BOOT_ADDRESS];
            for (address, byte) in changes {
                flash[*address] = *byte;
            }
            FlashContents::compare(&flash, &image).to_string()
        };
        assert_eq!(description_after(&[]), "the board has no program");
        assert_eq!(
            description_after(&[(1, 0xcf), (0x1000, 7)]),
            "the board has half a program, which does nothing"
        );
        assert_eq!(
            description_after(&[(0, 1), (1, 2), (2, 4)]),
            "the board has another program, of 3 bytes"
        );
        assert_eq!(
            description_after(&[(0, 1), (0x1fff, 7)]),
            "the board has another program, of 8192 bytes"
        );
    }

    #[test]
    fn lizard_firmware_is_described_with_its_version_and_its_robot() {
        let [paper, large] = ["paper", "large"].map(robot);
        let firmware_image =
            |robot: &Robot| Image::firmware(CODE, &robot.section()).expect("the image fits");
        let image = firmware_image(&paper);
        let robot_alone_image = Image::robot_alone(paper.section()).expect("the robot fits");
        let mut flash = image.bytes().to_vec();
        flash.resize(BOOT_ADDRESS, 0xff);
        let lizard_description = format!("the board has lizard {}", env!("CARGO_PKG_VERSION"));
        let robot_description = |robot: &Robot| {
            format!(
                "{lizard_description} robot {}",
                robot_label(robot.firmware())
            )
        };
        let description =
            |flash: &[u8], image: &Image| FlashContents::compare(flash, image).to_string();
        assert_eq!(
            description(&flash, &image),
            format!("{} already", robot_description(&paper))
        );
        assert_eq!(
            description(&flash, &robot_alone_image),
            format!("{} already", robot_description(&paper))
        );
        let large_image = firmware_image(&large);
        assert_eq!(description(&flash, &large_image), robot_description(&paper));
        // A sketch that is shorter than the firmware: the robot's section is still there.
        let mut sketch_flash = flash.clone();
        sketch_flash[..1000].fill(0x95);
        assert_eq!(
            description(&sketch_flash, &robot_alone_image),
            "the board has another program"
        );
        let mut damaged_flash = flash.clone();
        damaged_flash[ROBOT_ADDRESS + 100] ^= 1;
        assert_eq!(
            description(&damaged_flash, &image),
            format!("{lizard_description} with a damaged robot")
        );
        damaged_flash[ROBOT_ADDRESS..].fill(0xff);
        assert_eq!(
            description(&damaged_flash, &image),
            format!("{lizard_description} without a robot")
        );
        let mut other_build_flash = flash;
        other_build_flash[0x1000] ^= 1;
        assert_eq!(
            description(&other_build_flash, &image),
            robot_description(&paper).replace("has ", "has another build of ")
        );
    }
}
