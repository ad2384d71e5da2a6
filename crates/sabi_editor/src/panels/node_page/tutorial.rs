//! The tutorial, which is also the first page of the manual.

use egui::{ScrollArea, Ui};
use egui_commonmark::{CommonMarkCache, CommonMarkViewer};

/// Text of the tutorial with its pictures.
const MANUAL: &str = include_str!("../../../../../docs/editor/README.md");

/// Shows the tutorial. Returns whether it was closed.
pub(super) fn show(ui: &mut Ui, markdown: &mut CommonMarkCache, text: &mut String) -> bool {
    if text.is_empty() {
        *text = without_pictures(MANUAL);
    }
    let closes = ui.button("Close the tutorial").clicked();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        CommonMarkViewer::new().show(ui, markdown, text);
    });
    closes
}

/// A text without its pictures, which lie beside the manual and not in the program.
fn without_pictures(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("!["));
    lines.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tutorial_has_every_step_and_no_picture() {
        let text = without_pictures(MANUAL);
        for step in 1..=5 {
            assert!(text.contains(&format!("**{step}. ")), "step {step}");
        }
        assert!(!text.contains("]("), "neither pictures nor links that lead nowhere");
    }
}
