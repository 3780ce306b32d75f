//! The pose reports that `watch` asks for.

/// The timer of the pose reports.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    /// Frames from one report to the next; 0 for none.
    interval_frames: u16,
    /// Frames until the next report.
    frames_left: u16,
    /// True while a report waits to be written.
    pub(super) is_due: bool,
}

impl Watch {
    /// Makes a timer that reports once every `interval_frames` frames, first after as many; 0 for never.
    pub(super) const fn new(interval_frames: u16) -> Self {
        Self {
            interval_frames,
            frames_left: interval_frames,
            is_due: false,
        }
    }

    pub(super) fn count_frame(&mut self) {
        if self.interval_frames > 0 {
            self.frames_left -= 1;
            if self.frames_left == 0 {
                self.frames_left = self.interval_frames;
                self.is_due = true;
            }
        }
    }
}
