//! The menus of the settings of the whole document: size, lengths and seed.

use egui::containers::menu::MenuButton;
use egui::{Button, DragValue, Id, RichText, Ui, UiBuilder};
use sabi_editing::command::DocumentCommand;
use sabi_graph::Fit;

use super::stay_open;
use crate::action::Action;
use crate::context::ViewContext;
use crate::theme::type_size;

/// Texture sizes that are offered for editing.
pub(crate) const SIZES: [u32; 5] = [256, 512, 1024, 2048, 4096];

/// Largest of them.
pub(crate) const LARGEST_SIZE: u32 = SIZES[SIZES.len() - 1];

/// Buttons with the size at which the graph is worked on, the length that counts as 1, and the seed. Each opens a menu.
pub(super) fn menus(ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
    let size = context.evaluation.model.size();
    let document = context.document.contents();
    let mut command = None;
    let mut menu = |ui: &mut Ui, name: &str, words: String, contents: &dyn Fn(&mut Ui) -> Option<DocumentCommand>| {
        // With an id of its own, the menu stays open whatever appears and disappears beside the button.
        ui.scope_builder(UiBuilder::new().id(Id::new(("of the graph", name))), |ui| {
            let words = RichText::new(words).size(type_size::SMALL).color(context.theme.quiet);
            let button = MenuButton::from_button(Button::new(words).frame(false));
            let (button, _) = button.config(stay_open()).ui(ui, |ui| {
                command = contents(ui).or(command.take());
            });
            button.on_hover_text(name);
        });
    };
    menu(ui, "Working size", format!("{size} texels"), &|ui| sizes(ui, size));
    menu(ui, "Unit of lengths", format!("1 = {}", unit(document.fit)), &|ui| {
        fits(ui, document.fit)
    });
    menu(ui, "Seed of the graph", format!("seed {}", document.seed), &|ui| {
        seed(ui, document.seed)
    });
    command.map(Action::edit)
}

/// Length that counts as 1.
fn unit(fit: Fit) -> String {
    match fit {
        Fit::Unit => "largest side".to_owned(),
        Fit::Metres => "1 m".to_owned(),
        Fit::Length(metres) => format!("{metres} m"),
        Fit::Piece => "the piece".to_owned(),
    }
}

fn sizes(ui: &mut Ui, size: u32) -> Option<DocumentCommand> {
    ui.label("Texels along a side while working");
    let mut chosen = None;
    for offered in SIZES {
        if ui.radio(offered == size, format!("{offered} × {offered}")).clicked() {
            chosen = Some(DocumentCommand::SetSize(offered));
            ui.close();
        }
    }
    chosen
}

fn fits(ui: &mut Ui, fit: Fit) -> Option<DocumentCommand> {
    ui.label("A length of 1 in the graph is");
    let mut wanted = fit;
    ui.radio_value(&mut wanted, Fit::Unit, "the largest side of the model");
    ui.radio_value(&mut wanted, Fit::Metres, "a metre");
    ui.radio_value(&mut wanted, Fit::Piece, "the size of each piece")
        .on_hover_text("Small and large pieces age alike: planks, bolts and legs each get detail of their own size.");
    ui.horizontal(|ui| {
        let mut length = if let Fit::Length(length) = fit { length } else { 0.1 };
        let is_length = matches!(fit, Fit::Length(_));
        let chosen = ui.radio(is_length, "as many metres as").clicked();
        let field = DragValue::new(&mut length).speed(0.01).range(1e-4..=1e4);
        let is_changed = ui.add_enabled(is_length, field).changed();
        if chosen || is_changed {
            wanted = Fit::Length(length);
        }
    });
    (wanted != fit).then_some(DocumentCommand::SetFit(wanted))
}

fn seed(ui: &mut Ui, mut seed: u32) -> Option<DocumentCommand> {
    ui.horizontal(|ui| {
        let label = ui.label("Seed of the graph");
        let field = ui.add(DragValue::new(&mut seed)).labelled_by(label.id);
        field.changed().then_some(DocumentCommand::SetSeed(seed))
    })
    .inner
}
