//! Sentences that are shown over the window: notices for a few seconds, and failures until the user closes them.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use egui::{Align2, Area, Button, Context, Frame, Label, Order, RichText, Stroke, Ui, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;

use crate::theme::Theme;

/// Time that a sentence is shown.
const SHOWN_FOR: Duration = Duration::from_secs(6);
/// Most notices, and most failures, that are shown at once.
const MOST: usize = 4;
/// Width of the sentences, points.
const WIDTH: f32 = 560.0;
/// Room behind a sentence for the button that closes it, points.
const CLOSE_WIDTH: f32 = 28.0;
/// Distance from the lower edge of the window to the sentences, in points: above the status bar and the captions of the
/// views.
const ABOVE_EDGE: f32 = 58.0;

/// Work that can fail. Its next success removes the sentence about the failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    Save,
    Autosave,
    Export,
    Other,
}

/// Failure that the user has not closed yet.
struct FailureNotice {
    work: Work,
    sentence: String,
}

/// Sentences that are shown over the window, the oldest first.
#[derive(Default)]
pub(crate) struct Notices {
    shown: VecDeque<(Instant, String)>,
    failures: Vec<FailureNotice>,
}

impl Notices {
    /// Shows a sentence for a while; one that is shown already is shown again for the whole time.
    pub(crate) fn notify(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        self.shown.retain(|(_, known)| *known != sentence);
        self.shown.push_back((Instant::now(), sentence));
        while self.shown.len() > MOST {
            self.shown.pop_front();
        }
    }

    /// Shows why some work has failed, until the user closes the message or the work succeeds.
    pub(crate) fn fail(&mut self, work: Work, sentence: impl Into<String>) {
        let sentence = sentence.into();
        let is_known = |failure: &FailureNotice| {
            let is_replaced = work != Work::Other && failure.work == work;
            is_replaced || failure.sentence == sentence
        };
        self.failures.retain(|failure| !is_known(failure));
        self.failures.push(FailureNotice { work, sentence });
    }

    /// Removes the message about a failure of some work, since it has succeeded.
    pub(crate) fn succeed(&mut self, work: Work) {
        self.failures.retain(|failure| failure.work != work);
    }

    /// Draws the sentences over everything else, as `said` writes them, and removes those whose time is over or that
    /// were closed. Returns whether the button was pressed that saves the graph to another file.
    pub(crate) fn show(&mut self, ui: &Ui, theme: &Theme, said: &dyn Fn(&str) -> String) -> bool {
        let context = ui.ctx();
        let (top, saves) = self.show_failures(context, theme, said);
        self.shown.retain(|(since, _)| since.elapsed() < SHOWN_FOR);
        let Some((oldest, _)) = self.shown.front() else {
            return saves;
        };
        context.request_repaint_after(SHOWN_FOR.saturating_sub(oldest.elapsed()));
        let area = Area::new("notices".into()).order(Order::Tooltip).interactable(false);
        let corner = context.content_rect().center_bottom() - vec2(0.0, top);
        area.fixed_pos(corner).pivot(Align2::CENTER_BOTTOM).show(context, |ui| {
            for (_, sentence) in &self.shown {
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(WIDTH);
                    ui.label(with_capital(&said(sentence)));
                });
            }
        });
        saves
    }

    /// Draws the failures. Returns the distance in points from the lower edge of the window to the space above them,
    /// and whether the graph is to be saved to another file.
    fn show_failures(&mut self, context: &Context, theme: &Theme, said: &dyn Fn(&str) -> String) -> (f32, bool) {
        if self.failures.is_empty() {
            return (ABOVE_EDGE, false);
        }
        let area = Area::new("failures".into()).order(Order::Foreground);
        let corner = context.content_rect().center_bottom() - vec2(0.0, ABOVE_EDGE);
        let mut closed = None;
        let mut saves = false;
        let shown = area.fixed_pos(corner).pivot(Align2::CENTER_BOTTOM).show(context, |ui| {
            let hidden = self.failures.len().saturating_sub(MOST);
            if hidden > 0 {
                ui.colored_label(theme.quiet, format!("and {hidden} more"));
            }
            // The newest ones; more than one is rare.
            for (at, failure) in self.failures.iter().enumerate().skip(hidden) {
                let frame = Frame::popup(ui.style()).stroke(Stroke::new(1.0, theme.fault));
                frame.show(ui, |ui| {
                    if failure_row(ui, theme, &with_capital(&said(&failure.sentence))) {
                        closed = Some(at);
                    }
                    // The button closes the message, which would cover the question that it opens.
                    if failure.work == Work::Save && ui.button("Save as…").clicked() {
                        (closed, saves) = (Some(at), true);
                    }
                });
            }
        });
        if let Some(at) = closed {
            self.failures.remove(at);
            context.request_repaint();
        }
        (ABOVE_EDGE + shown.response.rect.height() + 4.0, saves)
    }

    /// Makes the shown sentences older.
    #[cfg(test)]
    pub(crate) fn age(&mut self, by: Duration) {
        for (since, _) in &mut self.shown {
            *since = since.checked_sub(by).unwrap_or(*since);
        }
    }

    /// Returns whether a sentence that contains this text is shown.
    #[cfg(test)]
    pub(crate) fn has(&self, part: &str) -> bool {
        let failures = self.failures.iter().map(|failure| &failure.sentence);
        let mut all = self.shown.iter().map(|(_, sentence)| sentence).chain(failures);
        all.any(|sentence| sentence.contains(part))
    }
}

/// Draws a sentence about a failure with a button that closes it. Returns whether it was pressed.
fn failure_row(ui: &mut Ui, theme: &Theme, sentence: &str) -> bool {
    ui.set_width(WIDTH);
    // As high as the text. A layout from the right would be as high as the window.
    ui.horizontal_top(|ui| {
        ui.colored_label(theme.fault, icon::WARNING);
        let width = ui.available_width() - CLOSE_WIDTH;
        ui.vertical(|ui| {
            ui.set_width(width);
            // Text that can be selected, since its paths may be needed elsewhere.
            ui.add(Label::new(RichText::new(sentence)).wrap().selectable(true));
        });
        let close = ui.add(Button::new(icon::X).frame(false)).on_hover_text("Close");
        close.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Close the message"));
        close.clicked()
    })
    .inner
}

/// The sentence with a capital at its beginning: reasons of refusals are written so that they fit behind a colon, too. One that
/// begins with the name of a file stays, as `graph.sabi:12:9: …` does.
pub(crate) fn with_capital(sentence: &str) -> String {
    let word = sentence.split_whitespace().next().unwrap_or_default();
    if word.contains(['.', '/', '\\', '_', ':']) {
        return sentence.to_owned();
    }
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
        assert_eq!(
            with_capital("goat.obj: there is no such file"),
            "goat.obj: there is no such file"
        );
        assert_eq!(with_capital(""), "");
    }

    #[test]
    fn a_failure_stays_until_the_work_succeeds() {
        let mut notices = Notices::default();
        notices.fail(Work::Save, "the disk is full");
        notices.fail(Work::Other, "no such model");
        notices.fail(Work::Save, "the disk is read-only");
        assert!(
            !notices.has("full") && notices.has("read-only"),
            "the newer one of a save"
        );
        notices.succeed(Work::Export);
        assert!(notices.has("read-only"));
        notices.succeed(Work::Save);
        assert!(!notices.has("read-only") && notices.has("no such model"));
    }
}
