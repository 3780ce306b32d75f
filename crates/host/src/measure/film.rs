//! A film's file, read and watched.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;

use lizard_film::{Film, Setup, Trouble, Watched};

use super::{frames, grey, through_ffmpeg};
use crate::Failure;
use crate::shared::files::note_input;

/// A film with its name.
pub(super) struct WatchedFilm {
    pub name: String,
    pub watched: Watched,
}

impl WatchedFilm {
    /// Reads a film, and finds camera and path in it.
    ///
    /// # Errors
    /// Fails for a film that cannot be read, or one whose tags tell no path.
    pub(super) fn read(path: &Path, rate: Option<f64>, setup: Setup) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let about = |trouble: Trouble| Failure::Input(format!("{name}: {trouble}"));
        let watched = read(path, rate, about)?.watch(setup).map_err(about)?;
        Ok(Self { name, watched })
    }

    /// The walks between rests; without any, all of the film, which cannot be measured for a reason.
    pub(super) fn walks(&self, rest: f64) -> Vec<Walk<'_>> {
        let mut walks = self.watched.walks(rest);
        if let ([], [first, .., last]) = (&walks[..], &self.watched.path[..]) {
            walks.push([first.seconds, last.seconds]);
        }
        let walk = |during| Walk { film: self, during };
        walks.into_iter().map(walk).collect()
    }

    /// Prints the path as CSV.
    pub(super) fn print_path(&self) -> Result<(), Failure> {
        let mut text = "seconds,forward,left,heading\n".to_owned();
        for seen in &self.watched.path {
            let place = seen.place;
            let _ = writeln!(
                text,
                "{:.4},{:.3},{:.3},{:.3}",
                seen.seconds,
                place.forward,
                place.left,
                place.heading.to_degrees()
            );
        }
        let mut out = io::stdout().lock();
        out.write_all(text.as_bytes())?;
        Ok(out.flush()?)
    }
}

/// A walk between two rests.
#[derive(Clone, Copy)]
pub(super) struct Walk<'f> {
    pub film: &'f WatchedFilm,
    /// Its times in the film, s, with a part of the rests.
    pub during: [f64; 2],
}

impl Walk<'_> {
    /// The place of a message.
    pub(super) fn at(&self) -> String {
        let [from, to] = self.during;
        format!("{}, {from:.1} to {to:.1} s", self.film.name)
    }
}

/// Reads a film.
fn read(
    path: &Path,
    rate: Option<f64>,
    about: impl Fn(Trouble) -> Failure,
) -> Result<Film, Failure> {
    let mut film = Film::default();
    if path.is_dir() {
        for (seconds, file) in frames::of_folder(path, rate)? {
            film.add(seconds, &grey::read(&file)?).map_err(&about)?;
        }
        return Ok(film);
    }
    if !path.is_file() {
        return Err(Failure::Input(format!(
            "there is no film {}",
            path.display()
        )));
    }
    through_ffmpeg::each(note_input(path), rate, |seconds, picture| {
        film.add(seconds, picture).map_err(&about)
    })?;
    Ok(film)
}
