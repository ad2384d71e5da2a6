//! Tablets on systems where none can be asked.

use super::{PenEvent, UNSUPPORTED};

/// Tablets of the system, of which there are none.
pub(super) enum Tablet {}

impl Tablet {
    /// Says why there are none; nothing where the frame has no window.
    pub(super) fn connect(frame: &eframe::Frame) -> Option<Result<Tablet, String>> {
        frame.winit_window()?;
        Some(Err(UNSUPPORTED.to_owned()))
    }

    /// Returns true if the system knows a tablet.
    pub(super) fn is_known(&self) -> bool {
        match *self {}
    }

    /// Events since the last time.
    pub(super) fn pump(&mut self) -> Result<Vec<PenEvent>, String> {
        match *self {}
    }
}
