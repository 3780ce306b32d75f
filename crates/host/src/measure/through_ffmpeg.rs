//! The reading of a film file's pictures through the programs ffmpeg and ffprobe.
//!
//! A film decoder is too large to be part of this program, and ffmpeg is available everywhere. ffprobe gives the time
//! of each picture, because the pictures of a phone are not evenly spaced in time. ffmpeg sends the pictures as
//! YUV4MPEG2: a line with the size, then for each picture a line and its grey pixels.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;
use std::process::{Command, Stdio};

use lizard_film::Picture;

use crate::Failure;

/// Arguments of ffmpeg after the file's name: a grey picture for each picture of the film.
const FFMPEG_ARGUMENTS: &str = "-fps_mode passthrough -f yuv4mpegpipe -pix_fmt gray -strict -1 -";
/// Arguments of ffprobe before the file's name: the times of the pictures.
const FFPROBE_ARGUMENTS: &str =
    "-v error -select_streams v:0 -show_entries frame=best_effort_timestamp_time -of csv=p=0";
/// Largest width or height of a picture, px.
const MAX_SIZE_PX: usize = 10_000;

/// Calls `handle_picture` for each picture of a film, with its time, s. The times follow from `rate`, pictures per
/// second, or are those of the film if `rate` is `None`.
///
/// # Errors
/// Fails if ffmpeg or ffprobe is missing or cannot read the film, or if `handle_picture` fails.
pub(super) fn for_each_picture(
    film: &Path,
    rate: Option<f64>,
    mut handle_picture: impl FnMut(f64, &Picture) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let times = match rate {
        Some(_) => Vec::new(),
        None => picture_times(film)?,
    };
    let failure_of = |reason: &str| {
        Failure::Input(format!(
            "{} is no film that ffmpeg can read: {reason}",
            film.display()
        ))
    };
    let mut ffmpeg = Command::new("ffmpeg")
        .args(["-v", "error", "-nostdin", "-i"])
        .arg(film)
        .args(FFMPEG_ARGUMENTS.split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| start_failure("ffmpeg", &error))?;
    let mut stream = BufReader::new(ffmpeg.stdout.take().expect("standard output is piped"));
    let mut line = String::new();
    let picture_size = stream
        .read_line(&mut line)
        .ok()
        .and_then(|_| parse_size(&line));
    let outcome = match picture_size {
        None => Err(failure_of("it sends no pictures")),
        Some([width, height]) => (0..)
            .try_fold((), |(), i: usize| {
                line.clear();
                match stream.read_line(&mut line) {
                    Ok(0) => return Err(None),
                    Ok(_) => {}
                    Err(error) => return Err(Some(failure_of(&error.to_string()))),
                }
                let mut grey = vec![0; width * height];
                let read_result = stream.read_exact(&mut grey);
                read_result.map_err(|_| Some(failure_of("its last picture is not whole")))?;
                let seconds = match rate {
                    Some(rate) => Some(i as f64 / rate),
                    None => times.get(i).copied(),
                };
                let seconds = seconds.ok_or_else(|| {
                    Some(failure_of("it has more pictures than times; give --fps"))
                })?;
                let grey = Picture::new(width, height, grey)
                    .ok_or_else(|| Some(failure_of("no pixels")))?;
                handle_picture(seconds, &grey).map_err(Some)
            })
            .or_else(|failure: Option<Failure>| failure.map_or(Ok(()), Err)),
    };
    // ffmpeg may still be sending pictures that are no longer read.
    drop(stream);
    let _ = ffmpeg.kill();
    let _ = ffmpeg.wait();
    outcome
}

/// Asks ffprobe for the times of a film's pictures, s.
fn picture_times(film: &Path) -> Result<Vec<f64>, Failure> {
    let output = Command::new("ffprobe")
        .args(FFPROBE_ARGUMENTS.split(' '))
        .arg(film)
        .output()
        .map_err(|error| start_failure("ffprobe", &error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    // A picture with side data is followed by a comma and an empty line.
    let lines = text.lines().map(|line| line.trim_end_matches(',').trim());
    let lines = lines.filter(|line| !line.is_empty());
    let times: Option<Vec<f64>> = lines.map(|line| line.parse().ok()).collect();
    match times {
        Some(times) if !times.is_empty() => Ok(times),
        _ => Err(Failure::Input(format!(
            "ffprobe tells no times of the pictures of {}; --fps 30 gives their number in a second",
            film.display()
        ))),
    }
}

/// Width and height of a YUV4MPEG2 stream, from its header line; `None` if the header is invalid.
fn parse_size(header: &str) -> Option<[usize; 2]> {
    let fields = header.trim().strip_prefix("YUV4MPEG2 ")?;
    let parse_field = |name: char| {
        let mut values = fields
            .split(' ')
            .filter_map(|field| field.strip_prefix(name));
        values
            .next()?
            .parse()
            .ok()
            .filter(|size| (1..=MAX_SIZE_PX).contains(size))
    };
    Some([parse_field('W')?, parse_field('H')?])
}

fn start_failure(program: &str, error: &std::io::Error) -> Failure {
    Failure::Impossible(match error.kind() {
        ErrorKind::NotFound => format!(
            "a film is read by the program {program}, which is not installed: install ffmpeg, or give a folder of \
             pictures"
        ),
        _ => format!("cannot run {program}: {error}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_is_read_from_the_header() {
        let header = "YUV4MPEG2 W1280 H720 F30:1 Ip A1:1 Cmono\n";
        assert_eq!(parse_size(header), Some([1280, 720]));
        for invalid_header in ["", "YUV4MPEG2 W0 H720", "YUV4MPEG2 W99999999 H1", "W1 H1"] {
            assert_eq!(parse_size(invalid_header), None, "{invalid_header}");
        }
    }
}
