//! Badge at a model that there are warnings about.

use egui::{RichText, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_engine::Warning;

use crate::notices::with_capital;
use crate::theme::{Theme, type_size};

/// Most warnings whose sentences the tooltip shows.
const MOST_SHOWN: usize = 4;

/// Shows the number of warnings about a model, if there are any. Returns whether it was clicked.
pub(crate) fn badge(ui: &mut Ui, theme: &Theme, model: &str, warnings: &[Warning]) -> bool {
    let count = warnings.len();
    if count == 0 {
        return false;
    }
    let sign = format!("{} {count}", icon::WARNING);
    let badge = ui.link(RichText::new(sign).color(theme.warning).size(type_size::SMALL));
    let name = format!("{} about {model}", counted(count));
    badge.widget_info(|| WidgetInfo::labeled(WidgetType::Link, true, &name));
    let badge = badge.on_hover_ui(|ui| {
        for warning in warnings.iter().take(MOST_SHOWN) {
            ui.label(with_capital(&warning.sentence));
        }
        if count > MOST_SHOWN {
            ui.label(format!("and {} more", count - MOST_SHOWN));
        }
    });
    badge.clicked()
}

/// Number of warnings in words.
pub(crate) fn counted(count: usize) -> String {
    match count {
        1 => "1 warning".to_owned(),
        several => format!("{several} warnings"),
    }
}
