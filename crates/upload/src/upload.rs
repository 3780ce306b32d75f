//! Writes an image to a board in an order in which an interruption is never dangerous.
//!
//! A cable may be pulled at any moment, and the chip then starts whatever is in flash; an incomplete program may move
//! the servos anywhere. Therefore, before any code changes, an idle loop replaces the page where the program starts:
//! pins then stay inputs, and servos get no pulses. Next, the other pages are written and read back. The first page is
//! written last.
//!
//! A robot alone is written in the same way: the first page of its section is blanked first and written last. The
//! firmware then finds a valid robot or none; without a robot, it reports a fault and moves no servo. Since the code
//! stays, its version mark ([`lizard_core::numbers::mark`]) must show that it can read this robot; this is checked
//! before anything is written.
//!
//! Pages that are already correct are not written: this saves time and wear (flash endures 10 000 writes, ATmega328P
//! data sheet, "Features").

use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use lizard_core::numbers::mark::Mark;
use lizard_core::numbers::section::{FORMAT, Header, MAGIC, Region};

use crate::board::Board;
use crate::chip::Chip;
use crate::contents::{FlashContents, IDLE_JUMP, Program};
use crate::image::{BLANK, BOOT_ADDRESS, Image, PAGE_BYTES, Page, ROBOT_ADDRESS};
use crate::loader::{Loader, LoaderError, LoaderKind};
use crate::target::{ImageTooLong, Target};

/// Largest number of attempts, each after a reset. The attempts alternate between the boot loaders' baud rates until a
/// boot loader answers.
const MAX_ATTEMPTS: usize = 4;
/// Index of the page where a robot's section begins.
const ROBOT_PAGE_INDEX: usize = ROBOT_ADDRESS / PAGE_BYTES;

/// The page operation in progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Reading the contents of flash.
    Reading,
    /// Writing pages.
    Writing,
    /// Reading back the written pages.
    Verifying,
}

/// The progress of an upload, for the user.
#[derive(Debug)]
pub enum Event<'a> {
    /// The board's flash has been read; reported once.
    Found(FlashContents),
    /// The step in progress, the number of finished pages, and that of all pages.
    Progress(Step, usize, usize),
    /// The board is reset for another attempt.
    Retry {
        /// The error of the last attempt.
        error: &'a LoaderError,
        /// The boot loader that was tried.
        tried_kind: LoaderKind,
        /// The boot loader that is tried next.
        next_kind: LoaderKind,
    },
}

/// The result of an upload.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PageCounts {
    /// Number of pages written.
    pub written: usize,
    /// Number of pages that were already correct.
    pub kept: usize,
}

/// The error of a failed upload.
#[derive(Debug, thiserror::Error)]
pub enum UploadError {
    /// No boot loader answers.
    #[error(
        "no boot loader answers. Is it a UNO or a Nano? Does another program have this port open? Is something \
         wired to D0 or D1? If USB does not reset the board, start the upload again and press the reset button \
         immediately afterwards"
    )]
    NoLoader,
    /// The chip is not an ATmega328P.
    #[error("the chip is {0}; the firmware is for {uno}. Nothing was written", uno = Chip::ATMEGA328P)]
    Chip(Chip),
    /// The image is a robot alone, but the board has no lizard firmware.
    #[error("{0}, and a robot alone moves nothing: write the firmware, too. Nothing was written")]
    NoLizard(FlashContents),
    /// The image is a robot alone, but the board's code reads another format.
    #[error(
        "{contents}, which reads robots of format {}; this robot has format {FORMAT}: write the \
         firmware, too. Nothing was written",
        mark.format
    )]
    Format {
        /// The contents of the board's flash.
        contents: FlashContents,
        /// The version mark of the board's code.
        mark: Mark,
    },
    /// The image reaches into the boot section.
    #[error(transparent)]
    TooLong(#[from] ImageTooLong),
    /// A byte of flash has the wrong value even after it was written twice.
    #[error(
        "the flash does not keep the byte at address {address:#06x}: written {written:#04x}, read \
         {read:#04x}. The flash is worn out, or the supply is too weak. {flash_state}"
    )]
    ByteNotKept {
        /// The address of the byte.
        address: usize,
        /// The byte that was written.
        written: u8,
        /// The byte that was read back.
        read: u8,
        /// The state of flash after the failure.
        flash_state: FlashState,
    },
    /// The connection failed.
    #[error("{error}. {flash_state}")]
    ConnectionFailed {
        /// The error of the boot loader.
        error: LoaderError,
        /// The state of flash after the failure.
        flash_state: FlashState,
    },
}

/// The state of flash after an upload has failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlashState {
    /// Flash holds its old contents.
    Unchanged,
    /// Flash holds the idle loop and a part of the code.
    IncompleteProgram,
    /// Flash holds the firmware and an incomplete robot, which the firmware rejects.
    IncompleteRobot,
}

impl fmt::Display for FlashState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unchanged => "Nothing was written: the board is unchanged",
            Self::IncompleteRobot => {
                "The board now has an incomplete robot: its firmware reports fault=robot and moves \
                 no servo. Write the robot again"
            }
            Self::IncompleteProgram => {
                "The board now has an incomplete program, which does nothing. Its boot loader is \
                 intact: write the program again"
            }
        })
    }
}

/// Writes an image to a board, and starts the program. Resets the board up to four times if it does not answer or if
/// bytes are lost.
///
/// # Errors
/// See [`UploadError`].
pub async fn upload<B: Board>(
    loader: &mut Loader<B>,
    image: &Image,
    target: Target,
    report: &mut dyn FnMut(Event<'_>),
) -> Result<PageCounts, UploadError> {
    let mut upload = Upload {
        loader,
        image,
        target,
        report,
        has_answered: false,
        has_reported: false,
        flash_state: FlashState::Unchanged,
        written_addresses: BTreeSet::new(),
    };
    let mut kinds = target.loader_kinds().iter().copied().cycle();
    let mut kind = kinds.next().unwrap_or_default();
    for attempt in 1.. {
        let error = match upload.run_attempt(kind).await {
            Ok(()) => break,
            Err(AttemptError::UploadFailed(error)) => return Err(error),
            Err(AttemptError::Loader(error)) => error,
        };
        if attempt == MAX_ATTEMPTS || !error.is_transient() {
            return Err(upload.to_upload_error(error));
        }
        let tried_kind = kind;
        if !upload.has_answered {
            kind = kinds.next().unwrap_or(kind);
        }
        (upload.report)(Event::Retry {
            error: &error,
            tried_kind,
            next_kind: kind,
        });
    }
    let written = upload.written_addresses.len();
    let kept = image.pages().len() - written;
    Ok(PageCounts { written, kept })
}

/// Resets a board, contacts its boot loader, starts the program in flash, and returns the kind of the boot loader.
///
/// # Errors
/// Fails if no boot loader answers, the chip is not an ATmega328P, or the connection fails.
pub async fn identify<B: Board>(loader: &mut Loader<B>) -> Result<LoaderKind, UploadError> {
    let connection_error = |error| UploadError::ConnectionFailed {
        error,
        flash_state: FlashState::Unchanged,
    };
    for &kind in Target::default().loader_kinds() {
        match loader.reset_and_sync(kind).await {
            Ok(()) => {
                let chip = Chip(loader.read_signature().await.map_err(connection_error)?);
                let _ = loader.leave().await;
                return match chip {
                    Chip::ATMEGA328P => Ok(kind),
                    chip => Err(UploadError::Chip(chip)),
                };
            }
            Err(error) if error.is_transient() => {}
            Err(error) => return Err(connection_error(error)),
        }
    }
    Err(UploadError::NoLoader)
}

/// The error of a failed attempt.
#[derive(Debug, thiserror::Error)]
enum AttemptError {
    /// The boot loader failed; another attempt may help.
    #[error(transparent)]
    Loader(#[from] LoaderError),
    /// The upload failed, and another attempt cannot help.
    #[error(transparent)]
    UploadFailed(#[from] UploadError),
}

/// The result of an attempt or a part of it.
type AttemptResult<T = ()> = Result<T, AttemptError>;

/// An upload in progress.
struct Upload<'a, B> {
    loader: &'a mut Loader<B>,
    image: &'a Image,
    /// The facts known before the boot loader answered.
    target: Target,
    /// The receiver of progress events.
    report: &'a mut dyn FnMut(Event<'_>),
    /// True if the loader has answered.
    has_answered: bool,
    /// True if the board's contents have been reported.
    has_reported: bool,
    /// The state of flash if the upload fails now.
    flash_state: FlashState,
    /// The addresses of the pages that were written in any attempt.
    written_addresses: BTreeSet<usize>,
}

impl<B: Board> Upload<'_, B> {
    /// Makes one attempt, from the reset to the start of the program.
    async fn run_attempt(&mut self, kind: LoaderKind) -> AttemptResult {
        self.loader.reset_and_sync(kind).await?;
        self.has_answered = true;
        let chip = Chip(self.loader.read_signature().await?);
        if chip != Chip::ATMEGA328P {
            return Err(UploadError::Chip(chip).into());
        }
        let room_check = self.target.check_room(self.image, kind);
        room_check.map_err(UploadError::from)?;
        let flash = self.read_flash(kind.start_address()).await?;
        let mut pages_to_write = self.image.pages();
        pages_to_write.retain(|page| flash[page.range()] != page.bytes);
        if !pages_to_write.is_empty() {
            let addresses = pages_to_write.iter().map(|page| page.address);
            self.written_addresses.extend(addresses);
            // The first page is replaced during the upload, so it is always written.
            let first_address = self.first_page().address;
            self.written_addresses.insert(first_address);
            self.write_pages(pages_to_write, &flash).await?;
        }
        // An error can be ignored: everything is written, and the program starts after a second in any case.
        let _ = self.loader.leave().await;
        Ok(())
    }

    /// The page without which the other pages have no effect: the page at address 0, or the first page of the robot's
    /// section.
    fn first_page(&self) -> Page {
        let mut pages = self.image.pages();
        pages.swap_remove(0)
    }

    /// Writes pages, and the image's first page last. Before the other pages, fills the first page with the idle loop
    /// or, for a robot alone, with blank bytes.
    async fn write_pages(&mut self, mut pages_to_write: Vec<Page>, flash: &[u8]) -> AttemptResult {
        let first_page = self.first_page();
        let mut placeholder = [BLANK; PAGE_BYTES];
        if self.image.is_robot_alone() {
            self.flash_state = FlashState::IncompleteRobot;
        } else {
            self.flash_state = FlashState::IncompleteProgram;
            placeholder[..IDLE_JUMP.len()].copy_from_slice(&IDLE_JUMP);
        }
        pages_to_write.retain(|page| page.address != first_page.address);
        if !pages_to_write.is_empty() && flash[first_page.range()] != placeholder {
            self.write_page(first_page.address, &placeholder).await?;
        }
        self.write_and_verify(&pages_to_write).await?;
        self.write_and_verify(&[first_page]).await
    }

    /// Reads flash up to the boot loader and reports its contents. For a robot alone, reads only the first page of
    /// the code and the pages of the old and the new robot.
    async fn read_flash(&mut self, boot_address: usize) -> AttemptResult<Vec<u8>> {
        let mut flash = vec![BLANK; BOOT_ADDRESS];
        if self.image.is_robot_alone() {
            self.read_pages(&mut flash, 0..1).await?;
            self.read_pages(&mut flash, ROBOT_PAGE_INDEX..ROBOT_PAGE_INDEX + 1)
                .await?;
            let old_end = find_robot_end(&flash, boot_address);
            let end_page = self.image.end_address().max(old_end).div_ceil(PAGE_BYTES);
            self.read_pages(&mut flash, ROBOT_PAGE_INDEX + 1..end_page)
                .await?;
        } else {
            self.read_pages(&mut flash, 0..boot_address / PAGE_BYTES)
                .await?;
        }
        let contents = FlashContents::compare(&flash, self.image);
        if self.image.is_robot_alone() {
            self.check_code(&contents)?;
        }
        if !self.has_reported {
            self.has_reported = true;
            (self.report)(Event::Found(contents));
        }
        Ok(flash)
    }

    /// Checks that the code in flash can read the new robot.
    fn check_code(&self, contents: &FlashContents) -> Result<(), UploadError> {
        let contents = contents.clone();
        match contents.program {
            Program::Lizard { mark, .. } if mark.format == FORMAT => Ok(()),
            Program::Lizard { mark, .. } => Err(UploadError::Format { contents, mark }),
            _ => Err(UploadError::NoLizard(contents)),
        }
    }

    /// Reads the pages with the given indices into `flash`, and reports the progress.
    async fn read_pages(&mut self, flash: &mut [u8], page_indices: Range<usize>) -> AttemptResult {
        let page_count = page_indices.len();
        for (done_count, page_index) in page_indices.enumerate() {
            let address = page_index * PAGE_BYTES;
            let page_bytes = self.loader.read_page(address).await?;
            flash[address..address + PAGE_BYTES].copy_from_slice(&page_bytes);
            (self.report)(Event::Progress(Step::Reading, done_count + 1, page_count));
        }
        Ok(())
    }

    /// Writes pages and reads them back. Writes a page once more if it does not read back as written.
    async fn write_and_verify(&mut self, pages: &[Page]) -> AttemptResult {
        for (index, page) in pages.iter().enumerate() {
            self.write_page(page.address, &page.bytes).await?;
            (self.report)(Event::Progress(Step::Writing, index + 1, pages.len()));
        }
        for (index, page) in pages.iter().enumerate() {
            let mut read_back = self.loader.read_page(page.address).await?;
            if read_back != page.bytes {
                self.write_page(page.address, &page.bytes).await?;
                read_back = self.loader.read_page(page.address).await?;
            }
            let mut byte_pairs = read_back.iter().zip(&page.bytes);
            if let Some(offset) = byte_pairs.position(|(read, written)| read != written) {
                let error = UploadError::ByteNotKept {
                    address: page.address + offset,
                    written: page.bytes[offset],
                    read: read_back[offset],
                    flash_state: self.flash_state,
                };
                return Err(error.into());
            }
            (self.report)(Event::Progress(Step::Verifying, index + 1, pages.len()));
        }
        Ok(())
    }

    /// Writes the page that starts at `address`.
    async fn write_page(&mut self, address: usize, bytes: &[u8; PAGE_BYTES]) -> AttemptResult {
        assert!(
            address < BOOT_ADDRESS,
            "an image ends before the boot loader"
        );
        Ok(self.loader.write_page(address, bytes).await?)
    }

    /// Converts the error of the last attempt to the error of the upload.
    fn to_upload_error(&self, error: LoaderError) -> UploadError {
        match error {
            LoaderError::Silent if !self.has_answered => UploadError::NoLoader,
            error => UploadError::ConnectionFailed {
                error,
                flash_state: self.flash_state,
            },
        }
    }
}

/// Reads the end address of the robot in flash from its header; returns the start address if the header is invalid.
/// Needs only the robot's first page.
fn find_robot_end(flash: &[u8], boot_address: usize) -> usize {
    let header: Header = Region::new(&flash[ROBOT_ADDRESS..]).read(0);
    let end = ROBOT_ADDRESS + usize::from(header.length);
    let is_valid = header.magic == MAGIC && end <= boot_address;
    if is_valid { end } else { ROBOT_ADDRESS }
}

#[cfg(test)]
pub(crate) mod tests;
