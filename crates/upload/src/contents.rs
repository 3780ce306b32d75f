//! The contents of a board's flash before an upload.
//!
//! Writing destroys the old contents, and the user may have chosen the wrong board; therefore the contents are reported
//! first. They are read from flash, since the firmware does not run during an upload.

use std::fmt;

use lizard_core::numbers::mark::Mark;
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::section::Region;

use crate::image::{BLANK, Image, PAGE_BYTES, Page, ROBOT_ADDRESS};

/// The code at address 0 during an upload: `rjmp .-2`, a jump to itself. The rest of the page is blank.
pub(super) const IDLE_JUMP: [u8; 2] = [0xff, 0xcf];

/// The contents of a board's flash, compared with an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlashContents {
    /// The program in flash.
    pub program: Program,
    /// The robot's section after the code. Only lizard firmware uses it.
    pub robot: RobotInFlash,
    /// True if flash already holds the image.
    pub has_image: bool,
}

/// The program in a board's flash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// No program, as on a new chip.
    Blank,
    /// The idle loop of an unfinished upload, which does nothing.
    Incomplete,
    /// Lizard firmware of any version.
    Lizard {
        /// The version mark in the code.
        mark: Mark,
        /// True if the code differs from the image's code, even if the versions are equal.
        is_different: bool,
    },
    /// A program that is not lizard firmware.
    Other {
        /// The size up to the last byte that is not blank; `None` if only the first page was read.
        byte_count: Option<usize>,
    },
}

/// The robot's section in a board's flash.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RobotInFlash {
    /// The section is blank.
    Blank,
    /// A valid robot, with its label of name and hash.
    Named(String),
    /// A section that is incomplete, damaged, or in another format.
    Damaged,
}

impl FlashContents {
    /// Compares `flash`, from address 0 to the boot loader, with an image. For a robot alone, only the first page and
    /// the robot's pages of `flash` must have been read.
    pub fn compare(flash: &[u8], image: &Image) -> Self {
        let pages = image.pages();
        let is_in_flash = |page: &&Page| flash[page.range()] == page.bytes;
        let code_pages = pages.iter().filter(|page| page.address < ROBOT_ADDRESS);
        let program = match Mark::read(flash) {
            Some(mark) => Program::Lizard {
                mark,
                is_different: !code_pages.clone().all(|page| is_in_flash(&page)),
            },
            None if flash[..2] == IDLE_JUMP && is_blank(&flash[2..PAGE_BYTES]) => {
                Program::Incomplete
            }
            None if image.is_robot_alone() && is_blank(&flash[..PAGE_BYTES]) => Program::Blank,
            None if image.is_robot_alone() => Program::Other { byte_count: None },
            None => match flash.iter().rposition(|&byte| byte != BLANK) {
                None => Program::Blank,
                Some(last_address) => Program::Other {
                    byte_count: Some(last_address + 1),
                },
            },
        };
        // Other programs do not use the robot's section: the section counts only together with lizard firmware.
        let has_code = matches!(program, Program::Lizard { .. }) || !image.is_robot_alone();
        let has_image = has_code && pages.iter().all(|page| is_in_flash(&page));
        let robot = match find_robot(flash) {
            Some(robot) => RobotInFlash::Named(format_robot_label(&robot)),
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

/// Formats a robot's name and hash as the firmware's banner does.
pub fn format_robot_label(robot: &Robot) -> String {
    let name: String = robot.name().map(char::from).collect();
    format!("{name} {:08x}", robot.hash())
}

/// Finds the robot in the contents of flash from address 0 on; returns `None` if there is no valid robot.
pub fn find_robot(flash: &[u8]) -> Option<Robot<'_>> {
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
            Program::Incomplete => f.write_str("an incomplete program, which does nothing")?,
            Program::Other { .. } if self.has_image => f.write_str("this program")?,
            Program::Other { byte_count: None } => f.write_str("another program")?,
            Program::Other {
                byte_count: Some(count),
            } => write!(f, "another program, of {count} bytes")?,
            Program::Lizard { mark, is_different } => {
                let [major, minor, patch] = mark.version;
                if is_different && mark == Mark::THIS_FIRMWARE {
                    f.write_str("another build of ")?;
                }
                write!(f, "lizard {major}.{minor}.{patch}")?;
                match &self.robot {
                    RobotInFlash::Blank => f.write_str(" without a robot")?,
                    RobotInFlash::Damaged => f.write_str(" with a damaged robot")?,
                    RobotInFlash::Named(label) => write!(f, " robot {label}")?,
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
    use crate::upload::tests::{CODE, load_robot};

    #[test]
    fn blank_flash_an_incomplete_program_and_another_program_are_distinguished() {
        let image = Image::new(vec![1, 2, 3]).expect("the image fits");
        let cases: [(&[(usize, u8)], &str); 4] = [
            (&[], "no program"),
            (
                &[(1, 0xcf), (0x1000, 7)],
                "an incomplete program, which does nothing",
            ),
            (&[(0, 1), (1, 2), (2, 4)], "another program, of 3 bytes"),
            (&[(0, 1), (0x1fff, 7)], "another program, of 8192 bytes"),
        ];
        for (changes, description) in cases {
            let mut flash = vec![0xff; BOOT_ADDRESS];
            for &(address, byte) in changes {
                flash[address] = byte;
            }
            let contents = FlashContents::compare(&flash, &image).to_string();
            assert_eq!(contents, format!("the board has {description}"));
        }
    }

    #[test]
    fn the_description_of_lizard_firmware_has_its_version_and_robot() {
        let [paper, large] = ["paper", "large"].map(load_robot);
        let build_image =
            |robot: &Robot| Image::firmware(CODE, &robot.section()).expect("the image fits");
        let image = build_image(&paper);
        let robot_alone_image = Image::robot_alone(paper.section()).expect("the robot fits");
        let mut flash = image.bytes().to_vec();
        flash.resize(BOOT_ADDRESS, 0xff);
        let lizard_description = format!("the board has lizard {}", env!("CARGO_PKG_VERSION"));
        let paper_label = format_robot_label(paper.firmware());
        let paper_description = format!("{lizard_description} robot {paper_label}");
        let describe =
            |flash: &[u8], image: &Image| FlashContents::compare(flash, image).to_string();
        let unchanged_description = format!("{paper_description} already");
        for image in [&image, &robot_alone_image] {
            assert_eq!(describe(&flash, image), unchanged_description);
        }
        assert_eq!(describe(&flash, &build_image(&large)), paper_description);
        // A sketch that is shorter than the firmware leaves the robot's section in flash.
        let mut sketch_flash = flash.clone();
        sketch_flash[..1000].fill(0x95);
        let sketch_description = describe(&sketch_flash, &robot_alone_image);
        assert_eq!(sketch_description, "the board has another program");
        let mut damaged_flash = flash.clone();
        damaged_flash[ROBOT_ADDRESS + 100] ^= 1;
        let expected = format!("{lizard_description} with a damaged robot");
        assert_eq!(describe(&damaged_flash, &image), expected);
        damaged_flash[ROBOT_ADDRESS..].fill(0xff);
        let expected = format!("{lizard_description} without a robot");
        assert_eq!(describe(&damaged_flash, &image), expected);
        let mut other_build_flash = flash;
        other_build_flash[0x1000] ^= 1;
        let expected = paper_description.replace("has ", "has another build of ");
        assert_eq!(describe(&other_build_flash, &image), expected);
    }
}
