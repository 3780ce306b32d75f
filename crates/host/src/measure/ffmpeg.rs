//! Reads the frames of a video file with the programs ffmpeg and ffprobe.
//!
//! A video decoder is too large to be part of this program, and ffmpeg is available everywhere. ffprobe gives the time
//! of each frame, because the frames of a phone's video are not evenly spaced in time. ffmpeg sends the frames as
//! YUV4MPEG2: a header line with the size, then, for each frame, a header line and its grey pixels.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;
use std::process::{Command, Stdio};

use lizard_video::Frame;

use crate::Failure;

/// Arguments of ffmpeg after the file's name: one grey frame for each frame of the video.
const FFMPEG_ARGUMENTS: &str = "-fps_mode passthrough -f yuv4mpegpipe -pix_fmt gray -strict -1 -";
/// Arguments of ffprobe before the file's name: the times of the frames.
const FFPROBE_ARGUMENTS: &str =
    "-v error -select_streams v:0 -show_entries frame=best_effort_timestamp_time -of csv=p=0";
/// Largest width or height of a frame, px.
const MAX_SIZE_PX: usize = 10_000;

/// Calls `handle_frame` with each frame of a video and the frame's time, s. The times are computed from `frame_rate`,
/// in frames per second, or read from the video if `frame_rate` is `None`.
///
/// # Errors
/// Fails if ffmpeg or ffprobe is missing or cannot read the video, or if `handle_frame` fails.
pub(super) fn for_each_frame(
    video: &Path,
    frame_rate: Option<f64>,
    handle_frame: impl FnMut(f64, &Frame) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let times = match frame_rate {
        Some(_) => Vec::new(),
        None => read_frame_times(video)?,
    };
    let unreadable = |reason: &str| {
        Failure::Input(format!(
            "ffmpeg cannot read {} as a video: {reason}",
            video.display()
        ))
    };
    let mut ffmpeg = Command::new("ffmpeg")
        .args(["-v", "error", "-nostdin", "-i"])
        .arg(file_url(video))
        .args(FFMPEG_ARGUMENTS.split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| spawn_failure("ffmpeg", &error))?;
    let stream = BufReader::new(ffmpeg.stdout.take().expect("standard output is piped"));
    let time_at = |index: usize| match frame_rate {
        Some(frame_rate) => Some(index as f64 / frame_rate),
        None => times.get(index).copied(),
    };
    let result = read_frames(stream, time_at, unreadable, handle_frame);
    // ffmpeg may still be sending frames that are no longer read.
    let _ = ffmpeg.kill();
    let _ = ffmpeg.wait();
    result
}

/// Returns the URL of a file. In a bare name such as `10:30.mp4`, ffmpeg would take the part before the colon for a
/// protocol.
fn file_url(path: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(path);
    url
}

/// Calls `handle_frame` with each frame in a YUV4MPEG2 stream and the frame's time, s.
fn read_frames(
    mut stream: impl BufRead,
    time_at: impl Fn(usize) -> Option<f64>,
    unreadable: impl Fn(&str) -> Failure,
    mut handle_frame: impl FnMut(f64, &Frame) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut line = String::new();
    let byte_count = stream.read_line(&mut line).ok();
    let frame_size = byte_count.and_then(|_| parse_size(&line));
    let [width, height] =
        frame_size.ok_or_else(|| unreadable("it has no frames, or ffmpeg is older than 5.1"))?;
    for index in 0.. {
        line.clear();
        let byte_count = stream.read_line(&mut line);
        if byte_count.map_err(|error| unreadable(&error.to_string()))? == 0 {
            break;
        }
        let mut pixels = vec![0; width * height];
        let read_result = stream.read_exact(&mut pixels);
        read_result.map_err(|_| unreadable("its last frame is incomplete"))?;
        let seconds = time_at(index)
            .ok_or_else(|| unreadable("it has more frames than times; give --fps"))?;
        let frame = Frame::new(width, height, pixels);
        let frame = frame.ok_or_else(|| unreadable("it has no pixels"))?;
        handle_frame(seconds, &frame)?;
    }
    Ok(())
}

/// Reads the times of a video's frames with ffprobe, s.
fn read_frame_times(video: &Path) -> Result<Vec<f64>, Failure> {
    let output = Command::new("ffprobe")
        .args(FFPROBE_ARGUMENTS.split(' '))
        .arg(file_url(video))
        .output()
        .map_err(|error| spawn_failure("ffprobe", &error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    // A frame with side data is followed by a comma and an empty line.
    let lines = text.lines().map(|line| line.trim_end_matches(',').trim());
    let lines = lines.filter(|line| !line.is_empty());
    let times: Option<Vec<f64>> = lines.map(|line| line.parse().ok()).collect();
    match times {
        Some(times) if !times.is_empty() => Ok(times),
        _ => Err(Failure::Input(format!(
            "ffprobe reports no frame times for {}: give the frames per second, for example --fps 30",
            video.display()
        ))),
    }
}

/// Parses the width and the height in the header line of a YUV4MPEG2 stream; `None` if the header is invalid.
fn parse_size(header: &str) -> Option<[usize; 2]> {
    let fields = header.trim().strip_prefix("YUV4MPEG2 ")?;
    let parse_field = |name: char| {
        let mut fields = fields.split(' ');
        let value = fields.find_map(|field| field.strip_prefix(name))?;
        let size = value.parse().ok();
        size.filter(|size| (1..=MAX_SIZE_PX).contains(size))
    };
    Some([parse_field('W')?, parse_field('H')?])
}

/// Returns the failure for a program that cannot be started.
fn spawn_failure(program: &str, error: &std::io::Error) -> Failure {
    Failure::Operation(match error.kind() {
        ErrorKind::NotFound => format!(
            "reading a video requires the program {program}, which is not installed: install ffmpeg, \
             or give a folder of frames"
        ),
        _ => format!("cannot run {program}: {error}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_gives_the_size_of_the_frames() {
        let header = "YUV4MPEG2 W1280 H720 F30:1 Ip A1:1 Cmono\n";
        assert_eq!(parse_size(header), Some([1280, 720]));
        for invalid_header in ["", "YUV4MPEG2 W0 H720", "YUV4MPEG2 W99999999 H1", "W1 H1"] {
            assert_eq!(parse_size(invalid_header), None, "{invalid_header}");
        }
    }
}
