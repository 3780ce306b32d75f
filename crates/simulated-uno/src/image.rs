//! A firmware image: the contents of flash and SRAM, read from an ELF or Intel HEX file.

use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use object::{Object, ObjectSegment, ObjectSymbol, SymbolKind};

/// The size of an ATmega328P's flash, bytes.
pub const FLASH_SIZE: u32 = 32 * 1024;
/// The first SRAM address of an ATmega328P, after the registers.
pub const SRAM_START: u16 = 0x0100;
/// The address after the last byte of SRAM.
pub const SRAM_END: u16 = 0x0900;

/// The size limit of a file, bytes: much more than an ELF file with 32 KiB of code and all debug information.
const MAX_FILE_BYTES: u64 = 4 << 20;

/// The address of the data space, which contains SRAM, in the single address space of avr-gcc's linker script.
const DATA_SPACE: u64 = 0x80_0000;
/// The address of the EEPROM in the single address space of avr-gcc's linker script.
const EEPROM_SPACE: u64 = 0x81_0000;

/// An error while an image is loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The path of the file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The bytes are not an ELF file.
    #[error("not an AVR ELF file: {0}")]
    Elf(#[from] object::read::Error),
    /// The file is longer than 4 MiB, the limit for any firmware.
    #[error("not an AVR ELF file: it is longer than {} MiB", MAX_FILE_BYTES >> 20)]
    TooLong,
    /// The ELF file is for another machine.
    #[error("not an AVR ELF file")]
    NotAvr,
    /// A segment does not fit into its memory.
    #[error("{size} bytes at {address:#x} do not fit an ATmega328P")]
    TooLarge {
        /// The address of the segment.
        address: u64,
        /// The size of the segment, bytes.
        size: u64,
    },
    /// The file has no code.
    #[error("the file contains no code")]
    Empty,
    /// A line of the file is not Intel HEX.
    #[error("line {line} is not Intel HEX: {reason}")]
    HexLine {
        /// The line's number, counted from 1.
        line: usize,
        /// The error in the line.
        reason: String,
    },
    /// The HEX file has no end record, so lines may be missing.
    #[error("the HEX file has no end record, so it is incomplete")]
    HexTruncated,
}

/// A named address in flash or SRAM.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Symbol {
    /// The linker's name of the symbol, mangled if the language mangles names.
    pub name: String,
    /// Byte address in flash, or 0x80_0000 plus the address in the data space.
    pub address: u64,
    /// The size in bytes, 0 if the compiler does not specify it.
    pub size: u64,
    /// True if the symbol is a function.
    pub is_function: bool,
}

impl Symbol {
    /// Returns the demangled name with its path, such as `core::console::Console::frame`.
    #[must_use]
    pub fn path(&self) -> String {
        let name = format!("{:#}", rustc_demangle::demangle(&self.name));
        // `<core::console::Console<Lizard>>::frame` becomes `core::console::Console::frame`: brackets around a type
        // are removed, brackets after a type are removed with their contents.
        let mut path = String::new();
        // For each open bracket: true if its contents are removed.
        let mut removals: Vec<bool> = Vec::new();
        for character in name.chars() {
            match character {
                '<' => removals
                    .push(path.ends_with(|last: char| last.is_alphanumeric() || last == ':')),
                '>' if !path.ends_with('-') => {
                    removals.pop();
                }
                _ if removals.contains(&true) => {}
                _ => path.push(character),
            }
        }
        path.trim_end_matches("::").to_owned()
    }

    fn matches_path(&self, path: &str) -> bool {
        let own_path = self.path();
        let outer = own_path.strip_suffix(path);
        outer.is_some_and(|outer| outer.is_empty() || outer.ends_with("::"))
    }
}

/// Returns the segment of these bytes at a byte address in flash.
///
/// # Errors
/// Returns [`LoadError::TooLarge`] if the bytes are not inside flash.
pub(crate) fn flash_segment(address: u64, bytes: Vec<u8>) -> Result<(u32, Vec<u8>), LoadError> {
    let size = bytes.len() as u64;
    if address + size > u64::from(FLASH_SIZE) {
        return Err(LoadError::TooLarge { address, size });
    }
    Ok((address as u32, bytes))
}

/// A firmware image, ready to load.
#[derive(Debug, Clone)]
pub struct Image {
    /// The segments in flash: byte address and bytes.
    segments: Vec<(u32, Vec<u8>)>,
    symbols: Vec<Symbol>,
    data_end: u16,
}

impl Image {
    /// Reads an ELF file or, with the feature `hex`, an Intel HEX file, which begins with a colon.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        let path = path.as_ref();
        let to_read_error = |source| LoadError::Read {
            path: path.to_owned(),
            source,
        };
        let mut bytes = Vec::new();
        let file = std::fs::File::open(path).map_err(to_read_error)?;
        let read_result = file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes);
        if read_result.map_err(to_read_error)? as u64 > MAX_FILE_BYTES {
            return Err(LoadError::TooLong);
        }
        #[cfg(feature = "hex")]
        if bytes.trim_ascii_start().starts_with(b":") {
            return Self::parse_hex(&String::from_utf8_lossy(&bytes));
        }
        Self::parse(&bytes)
    }

    /// Reads an ELF file from memory.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn parse(bytes: &[u8]) -> Result<Self, LoadError> {
        use object::read::elf::{ElfFile32, ProgramHeader};
        let file = ElfFile32::<object::Endianness>::parse(bytes)?;
        if file.architecture() != object::Architecture::Avr {
            return Err(LoadError::NotAvr);
        }
        let endian = file.endian();
        let mut segments = Vec::new();
        let mut data_end = SRAM_START;
        for segment in file.segments() {
            let header = segment.elf_program_header();
            let load_address = u64::from(header.p_paddr(endian));
            let run_address = segment.address();
            if (DATA_SPACE..EEPROM_SPACE).contains(&run_address) {
                let end = run_address + segment.size() - DATA_SPACE;
                if end > u64::from(SRAM_END) {
                    let (address, size) = (run_address, segment.size());
                    return Err(LoadError::TooLarge { address, size });
                }
                data_end = data_end.max(end as u16);
            }
            let data = segment.data()?;
            if load_address >= DATA_SPACE || data.is_empty() {
                continue; // EEPROM and fuses are not flash; .bss has no bytes
            }
            segments.push(flash_segment(load_address, data.to_vec())?);
        }
        if segments.is_empty() {
            return Err(LoadError::Empty);
        }
        let symbols = file.symbols().filter_map(|symbol| {
            let name = symbol.name().ok().filter(|name| !name.is_empty())?;
            Some(Symbol {
                name: name.to_owned(),
                address: symbol.address(),
                size: symbol.size(),
                is_function: symbol.kind() == SymbolKind::Text,
            })
        });
        Ok(Self {
            segments,
            symbols: symbols.collect(),
            data_end,
        })
    }

    /// Creates an image from segments that are inside flash.
    #[cfg(feature = "hex")]
    pub(crate) fn from_segments(segments: Vec<(u32, Vec<u8>)>) -> Self {
        Self {
            segments,
            symbols: Vec::new(),
            data_end: SRAM_START,
        }
    }

    /// The number of flash bytes in use: code, tables and initial values.
    #[must_use]
    pub fn flash_used(&self) -> u32 {
        let sizes = self.segments.iter().map(|(_, data)| data.len() as u32);
        sizes.sum()
    }

    /// The number of SRAM bytes that static data use (.data, .bss and .noinit).
    #[must_use]
    pub fn static_ram(&self) -> u16 {
        self.data_end - SRAM_START
    }

    /// The first SRAM address after static data.
    #[must_use]
    pub fn data_end(&self) -> u16 {
        self.data_end
    }

    /// All symbols, in the file's order.
    #[must_use]
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// Finds the symbol with exactly this linker name; `None` if there is no such symbol.
    #[must_use]
    pub fn symbol(&self, name: &str) -> Option<&Symbol> {
        self.symbols.iter().find(|symbol| symbol.name == name)
    }

    /// Finds the only function whose path ends with `path`, such as `frame` or `Console::frame`. `None` if no function
    /// has such a path (the compiler may have inlined it), or if several functions at different addresses have.
    #[must_use]
    pub fn function(&self, path: &str) -> Option<&Symbol> {
        self.find_unique_symbol(path, |symbol| symbol.is_function)
    }

    /// Finds the data address of the only variable whose path ends with `path`, such as `pulses::LATE_EDGES`. `None` if
    /// no variable has such a path, or if several variables at different addresses have.
    #[must_use]
    pub fn variable(&self, path: &str) -> Option<u16> {
        let is_in_data_space =
            |symbol: &Symbol| (DATA_SPACE..EEPROM_SPACE).contains(&symbol.address);
        let symbol = self.find_unique_symbol(path, is_in_data_space)?;
        Some((symbol.address - DATA_SPACE) as u16)
    }

    /// Finds the only symbol of a kind whose path ends with `path`. `None` if no symbol matches, or if several symbols
    /// at different addresses match.
    fn find_unique_symbol(
        &self,
        path: &str,
        is_of_kind: impl Fn(&Symbol) -> bool,
    ) -> Option<&Symbol> {
        let is_match = |symbol: &&Symbol| is_of_kind(symbol) && symbol.matches_path(path);
        let mut matching_symbols = self.symbols.iter().filter(is_match);
        let first_match = matching_symbols.next()?;
        matching_symbols
            .all(|symbol| symbol.address == first_match.address)
            .then_some(first_match)
    }

    /// Returns the contents of flash from address 0 to the last used byte; 0xff where the image has no data.
    #[must_use]
    pub fn flash(&self) -> Vec<u8> {
        let mut flash = vec![0xff; self.code_end() as usize];
        for (start, bytes) in &self.segments {
            let start = *start as usize;
            flash[start..start + bytes.len()].copy_from_slice(bytes);
        }
        flash
    }

    /// Writes bytes to the start of a range in flash and removes all other data in the range. This replaces the data of
    /// a compiled program without compiling it again.
    ///
    /// # Errors
    /// Returns [`LoadError::TooLarge`] if the range is not inside flash or is too short for the bytes.
    pub fn replace(&mut self, range: Range<u32>, bytes: &[u8]) -> Result<(), LoadError> {
        let size = bytes.len() as u64;
        if range.end > FLASH_SIZE || u64::from(range.start) + size > u64::from(range.end) {
            let address = range.start.into();
            return Err(LoadError::TooLarge { address, size });
        }
        let mut segments = Vec::new();
        for (start, bytes) in self.segments.drain(..) {
            let length = bytes.len();
            let head_end = (range.start.saturating_sub(start) as usize).min(length);
            let tail_start = (range.end.saturating_sub(start) as usize).min(length);
            for kept_range in [0..head_end, tail_start..length] {
                if !kept_range.is_empty() {
                    segments.push((start + kept_range.start as u32, bytes[kept_range].to_vec()));
                }
            }
        }
        segments.push((range.start, bytes.to_vec()));
        self.segments = segments;
        Ok(())
    }

    /// The address of the first used byte in flash; 0 if the image is empty.
    pub(crate) fn code_start(&self) -> u32 {
        let starts = self.segments.iter().map(|(address, _)| *address);
        starts.min().unwrap_or(0)
    }

    /// The address after the last used byte in flash; 0 if the image is empty.
    pub(crate) fn code_end(&self) -> u32 {
        let end = |(address, data): &(u32, Vec<u8>)| address + data.len() as u32;
        self.segments.iter().map(end).max().unwrap_or(0)
    }
}
