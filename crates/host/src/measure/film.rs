//! Reads a film from its file, and finds the robot's path in it.

use std::fmt::Display;
use std::fs;
use std::path::Path;

use lizard_film::{Film, Picture, Setup, Trouble};
use lizard_measure::NamedFilm;

use super::{frames, through_ffmpeg};
use crate::Failure;
use crate::shared::files::note_input;

/// Reads a film, and finds the camera and the robot's path in it.
///
/// # Errors
/// Fails for a film that cannot be read, or one whose tags show no path.
pub(super) fn analyse(path: &Path, rate: Option<f64>, setup: Setup) -> Result<NamedFilm, Failure> {
    let name = path.display().to_string();
    let failure_of = |error: Trouble| film_failure(&name, &error);
    let analysis = read_film(path, rate, failure_of)?
        .analyse(setup)
        .map_err(failure_of)?;
    Ok(NamedFilm { name, analysis })
}

/// The failure of a film, with its name and the reason.
pub(super) fn film_failure(name: &str, reason: &dyn Display) -> Failure {
    Failure::Input(format!("{name}: {reason}"))
}

/// Reads a film from its file, or from a folder of pictures.
fn read_film(
    path: &Path,
    rate: Option<f64>,
    failure_of: impl Fn(Trouble) -> Failure,
) -> Result<Film, Failure> {
    let mut film = Film::default();
    if path.is_dir() {
        for (seconds, file) in frames::list_pictures(path, rate)? {
            film.add(seconds, &read_picture(&file)?)
                .map_err(&failure_of)?;
        }
        return Ok(film);
    }
    if !path.is_file() {
        return Err(Failure::Input(format!(
            "there is no film {}",
            path.display()
        )));
    }
    through_ffmpeg::for_each_picture(note_input(path), rate, |seconds, picture| {
        film.add(seconds, picture).map(|_| ()).map_err(&failure_of)
    })?;
    Ok(film)
}

/// Reads a PNG or JPEG file as a grey picture.
fn read_picture(path: &Path) -> Result<Picture, Failure> {
    let name = path.display();
    let bytes =
        fs::read(path).map_err(|error| Failure::Input(format!("cannot read {name}: {error}")))?;
    Picture::decode(&bytes).map_err(|reason| {
        Failure::Input(format!("{name} is no picture that can be read: {reason}"))
    })
}
