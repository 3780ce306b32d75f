//! The timer of the pose reports requested by `watch`.

/// A timer that requests a pose report at regular intervals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    /// Frames from one report to the next; 0 if there are no reports.
    interval_frames: u16,
    /// Frames until the next report.
    frames_left: u16,
    /// True while a report waits to be written.
    pub(super) is_report_pending: bool,
}

impl Watch {
    /// Creates a timer that requests a report every `interval_frames` frames, or never if that is 0.
    pub(super) const fn new(interval_frames: u16) -> Self {
        Self {
            interval_frames,
            frames_left: interval_frames,
            is_report_pending: false,
        }
    }

    /// Counts a frame, and requests a report at the end of each interval.
    pub(super) fn count_frame(&mut self) {
        if self.interval_frames > 0 {
            self.frames_left -= 1;
            if self.frames_left == 0 {
                self.frames_left = self.interval_frames;
                self.is_report_pending = true;
            }
        }
    }
}
