//! Pose reports, as `watch` asks for them.

/// The timer of the pose reports.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    /// Frames from one report to the next; 0 for none.
    every: u16,
    /// Frames until the next report.
    left: u16,
    /// True while a report waits to be written.
    pub(super) due: bool,
}

impl Watch {
    /// Reports every this many frames, the first after as many.
    pub(super) const fn every(frames: u16) -> Self {
        Self {
            every: frames,
            left: frames,
            due: false,
        }
    }

    pub(super) fn frame(&mut self) {
        if self.every > 0 {
            self.left -= 1;
            if self.left == 0 {
                self.left = self.every;
                self.due = true;
            }
        }
    }
}
