//! An analysed video with its name, and the walks in it.

use std::fmt::Write as _;

use lizard_video::AnalysedVideo;

/// An analysed video with its name.
#[derive(Debug, Clone)]
pub struct NamedVideo {
    /// The name in messages, such as the file's path.
    pub name: String,
    /// The camera and the robot's path in the video.
    pub analysis: AnalysedVideo,
}

impl NamedVideo {
    /// Finds the walks between rests of at least `min_rest` seconds. If there are none, the whole video counts as a
    /// walk, so that its measurement fails with a reason.
    pub(crate) fn find_walks(&self, min_rest: f64) -> Vec<Walk<'_>> {
        let mut intervals = self.analysis.find_walks(min_rest);
        if intervals.is_empty() {
            intervals.extend(self.time_range());
        }
        let to_walk = |interval| Walk {
            video: self,
            interval,
        };
        intervals.into_iter().map(to_walk).collect()
    }

    /// Returns the times of the first and the last point of the path, s; `None` if it has fewer than two points.
    pub(crate) fn time_range(&self) -> Option<[f64; 2]> {
        match &self.analysis.path[..] {
            [first, .., last] => Some([first.seconds, last.seconds]),
            _ => None,
        }
    }

    /// Formats the robot's path as CSV with the columns `seconds,forward,left,heading`, in mm and deg on the floor.
    pub fn format_path_csv(&self) -> String {
        let mut text = "seconds,forward,left,heading\n".to_owned();
        for point in &self.analysis.path {
            let pose = point.pose;
            let _ = writeln!(
                text,
                "{:.4},{:.3},{:.3},{:.3}",
                point.seconds,
                pose.forward,
                pose.left,
                pose.heading.to_degrees()
            );
        }
        text
    }
}

/// A walk between two rests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Walk<'f> {
    pub video: &'f NamedVideo,
    /// Start and end in the video, s; both include a part of the adjacent rest.
    pub interval: [f64; 2],
}

impl Walk<'_> {
    /// Formats the walk's label in messages: the video and the times.
    pub(crate) fn format_label(&self) -> String {
        let [from, to] = self.interval;
        format!("{}, {from:.1} to {to:.1} s", self.video.name)
    }
}
