//! Sentences that are shown for a few seconds.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use egui::{Align2, Area, Frame, Order, Ui, vec2};

/// Time that a sentence is shown.
const SHOWN_FOR: Duration = Duration::from_secs(6);
/// Sentences that are shown at once.
const MOST: usize = 4;

/// Sentences that are shown for a few seconds, the oldest first.
#[derive(Default)]
pub(crate) struct Notices {
    shown: VecDeque<(Instant, String)>,
}

impl Notices {
    /// Shows a sentence; one that is shown already is shown again for the whole time.
    pub(crate) fn notify(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        self.shown.retain(|(_, known)| *known != sentence);
        self.shown.push_back((Instant::now(), sentence));
        while self.shown.len() > MOST {
            self.shown.pop_front();
        }
    }

    /// Draws the sentences over everything else, and removes those whose time is over.
    pub(crate) fn show(&mut self, ui: &Ui) {
        self.shown.retain(|(said, _)| said.elapsed() < SHOWN_FOR);
        let Some((oldest, _)) = self.shown.front() else {
            return;
        };
        ui.ctx()
            .request_repaint_after(SHOWN_FOR.saturating_sub(oldest.elapsed()));
        let area = Area::new("notices".into()).order(Order::Tooltip).interactable(false);
        let corner = ui.ctx().content_rect().center_bottom() - vec2(0.0, 40.0);
        area.fixed_pos(corner)
            .pivot(Align2::CENTER_BOTTOM)
            .show(ui.ctx(), |ui| {
                for (_, sentence) in &self.shown {
                    Frame::popup(ui.style()).show(ui, |ui| {
                        ui.set_max_width(560.0);
                        ui.label(with_capital(sentence));
                    });
                }
            });
    }

    /// Returns whether a sentence that contains this text is shown.
    #[cfg(test)]
    pub(crate) fn has(&self, part: &str) -> bool {
        self.shown.iter().any(|(_, sentence)| sentence.contains(part))
    }
}

/// The sentence with a capital at its beginning: reasons of refusals are written so that they fit behind a colon, too.
fn with_capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_begins_with_a_capital() {
        assert_eq!(with_capital("no node is muted"), "No node is muted");
        assert_eq!(with_capital("'Blur' is read"), "'Blur' is read");
        assert_eq!(with_capital(""), "");
    }
}
