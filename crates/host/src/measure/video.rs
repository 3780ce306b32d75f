//! Reads a video from its file or a folder of frames, and finds the robot's path in it.

use std::fmt::Display;
use std::fs;
use std::path::Path;

use lizard_measure::NamedVideo;
use lizard_video::{Frame, Setup, Video, VideoError};

use super::recording::RecordingArgs;
use super::{ffmpeg, frames};
use crate::Failure;
use crate::shared::files::record_input;

impl RecordingArgs {
    /// Reads a video, and finds the camera and the robot's path in it.
    ///
    /// # Errors
    /// Fails if the video cannot be read, or if its tags show no path.
    pub(super) fn analyse(&self, path: &Path, setup: Setup) -> Result<NamedVideo, Failure> {
        let name = path.display().to_string();
        let to_failure = |error: VideoError| video_failure(&name, &error);
        let mut video = Video::default();
        let mut add_frame = |seconds: f64, frame: &Frame| {
            let result = video.add_frame(seconds, frame);
            result.map(|_| ()).map_err(to_failure)
        };
        if path.is_dir() {
            for (seconds, frame_path) in frames::list_frames(path, self.fps)? {
                add_frame(seconds, &read_frame(&frame_path)?)?;
            }
        } else if path.is_file() {
            ffmpeg::for_each_frame(record_input(path), self.fps, add_frame)?;
        } else {
            return Err(Failure::Input(format!(
                "{name} is neither a video file nor a folder of frames"
            )));
        }
        let analysis = video.analyse(setup).map_err(to_failure)?;
        Ok(NamedVideo { name, analysis })
    }
}

/// Returns the failure of a video, with the video's name and the reason.
pub(super) fn video_failure(name: &str, reason: &dyn Display) -> Failure {
    Failure::Input(format!("{name}: {reason}"))
}

/// Reads a frame from a PNG or JPEG file.
fn read_frame(path: &Path) -> Result<Frame, Failure> {
    let name = path.display();
    let bytes = fs::read(record_input(path))
        .map_err(|error| Failure::Input(format!("cannot read {name}: {error}")))?;
    Frame::decode(&bytes)
        .map_err(|_| Failure::Input(format!("{name} is not a complete PNG or JPEG file")))
}
