//! The pose reports that `watch` asks for.

/// The timer of the pose reports.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    /// Frames from one report to the next; 0 for none.
    every: u16,
    /// Frames until the next report.
    left: u16,
    /// True while a report waits to be written.
    pub(super) is_due: bool,
}

impl Watch {
    /// Reports once every so many frames, the first after as many.
    pub(super) const fn every(frames: u16) -> Self {
        Self {
            every: frames,
            left: frames,
            is_due: false,
        }
    }

    pub(super) fn frame(&mut self) {
        if self.every > 0 {
            self.left -= 1;
            if self.left == 0 {
                self.left = self.every;
                self.is_due = true;
            }
        }
    }
}
