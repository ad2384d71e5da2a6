//! The color picker: a plane of saturation and value, numbers, and the colors that were picked before.

use egui::color_picker::{Alpha, color_picker_hsva_2d};
use egui::ecolor::{hsv_from_rgb, rgb_from_hsv};
use egui::epaint::Hsva;
use egui::{
    Color32, Context, DragValue, Id, ScrollArea, Sense, StrokeKind, TextEdit, Ui, WidgetInfo, WidgetType, vec2,
};

use super::text_field::select_all;
use super::values::{code_of, color_of};

/// Width of the picker.
const PICKER: f32 = 190.0;
/// Most colors that are remembered, and the side of each, points.
const MOST_SWATCHES: usize = 16;
const SWATCH: f32 = 18.0;

/// Length of the code of a color: `#` and six digits.
const CODE: usize = 7;

/// Shows a picker; returns whether the color has changed.
///
/// A text field asks the next area around it to scroll to its cursor. Without an area of its own, the picker would scroll
/// the panel that it opens over, and would move with it.
pub(crate) fn picker(ui: &mut Ui, picked: &mut Hsva) -> bool {
    ScrollArea::neither().show(ui, |ui| parts(ui, picked)).inner
}

fn parts(ui: &mut Ui, picked: &mut Hsva) -> bool {
    ui.spacing_mut().slider_width = PICKER;
    let mut has_changed = color_picker_hsva_2d(ui, picked, Alpha::Opaque);
    has_changed |= numbers(ui, picked);
    has_changed |= hex(ui, picked);
    if let Some(color) = swatches(ui) {
        *picked = Hsva::from_srgb([color.r(), color.g(), color.b()]);
        has_changed = true;
    }
    has_changed
}

/// Hue in degrees, saturation and value in percent, of the encoded color, as in other programs: the picker's own are linear.
fn numbers(ui: &mut Ui, picked: &mut Hsva) -> bool {
    let code = picked.to_srgb();
    // A gray has no hue, so the typed one is kept while it gives this color.
    let kept_as = ui.id().with("typed numbers");
    let kept = ui.data(|data| data.get_temp::<([u8; 3], [f32; 3])>(kept_as));
    let kept = kept.filter(|(of, _)| *of == code);
    let mut parts = kept.map_or_else(|| hsv_of(code), |(_, parts)| parts);
    let mut has_changed = false;
    ui.horizontal(|ui| {
        let fields = [
            ("H", "Hue", 360.0, "°"),
            ("S", "Saturation", 100.0, "%"),
            ("V", "Value", 100.0, "%"),
        ];
        for (part, (sign, name, most, unit)) in parts.iter_mut().zip(fields) {
            let mut number = *part * most;
            let field = DragValue::new(&mut number)
                .prefix(format!("{sign} "))
                .suffix(unit)
                .range(0.0..=most)
                .max_decimals(0);
            let field = ui.add(field);
            field.widget_info(|| WidgetInfo::labeled(WidgetType::DragValue, true, name));
            if field.on_hover_text(name).changed() {
                *part = number / most;
                has_changed = true;
            }
        }
    });
    if has_changed {
        let code = srgb_of(parts);
        *picked = Hsva::from_srgb(code);
        ui.data_mut(|data| data.insert_temp(kept_as, (code, parts)));
    }
    has_changed
}

/// Field for the code of the color, such as `#6b3a1e`, which is taken as soon as it is whole.
fn hex(ui: &mut Ui, picked: &mut Hsva) -> bool {
    let id = ui.id().with("hex");
    let [r, g, b] = picked.to_srgb();
    let now = code_of(Color32::from_rgb(r, g, b));
    let typed = ui.data(|data| data.get_temp::<String>(id));
    let mut text = typed
        .filter(|_| ui.memory(|memory| memory.has_focus(id)))
        .unwrap_or(now);
    let field = ui.horizontal(|ui| {
        ui.label("Hex");
        ui.add(TextEdit::singleline(&mut text).id(id).desired_width(80.0))
    });
    let field = field.inner;
    field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Code of the color"));
    if field.gained_focus() {
        select_all(&field, &text);
    }
    let has_changed = field.changed();
    ui.data_mut(|data| data.insert_temp(id, text.clone()));
    let code = text.trim();
    let code = if code.starts_with('#') {
        code.to_owned()
    } else {
        format!("#{code}")
    };
    // Three digits are a color, too, but most often the beginning of six.
    let is_whole = has_changed && code.len() == CODE;
    let Some(color) = color_of(&code).filter(|_| is_whole) else {
        return false;
    };
    *picked = Hsva::from_srgb([color.r(), color.g(), color.b()]);
    true
}

/// Hue, saturation and value, each 0 to 1, of an encoded color.
fn hsv_of(code: [u8; 3]) -> [f32; 3] {
    let (hue, saturation, value) = hsv_from_rgb(code.map(|part| f32::from(part) / 255.0));
    [hue, saturation, value]
}

/// Encoded color of a hue, saturation and value.
fn srgb_of([hue, saturation, value]: [f32; 3]) -> [u8; 3] {
    rgb_from_hsv((hue, saturation, value)).map(|part| (part * 255.0).round() as u8)
}

/// Colors that were picked before, the last one first. Returns the clicked one.
fn swatches(ui: &mut Ui) -> Option<Color32> {
    let known = remembered(ui.ctx());
    if known.is_empty() {
        return None;
    }
    let mut chosen = None;
    ui.set_max_width(PICKER);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        for color in known {
            let (rect, response) = ui.allocate_exact_size(vec2(SWATCH, SWATCH), Sense::click());
            let name = format!("Picked before: {}", code_of(color));
            response.widget_info(|| WidgetInfo::labeled(WidgetType::ColorButton, true, &name));
            let line = ui.visuals().widgets.noninteractive.bg_stroke;
            ui.painter().rect(rect, 2.0, color, line, StrokeKind::Inside);
            if response.on_hover_text(code_of(color)).clicked() {
                chosen = Some(color);
            }
        }
    });
    chosen
}

/// Puts a color that was picked to the front of those that pickers offer.
pub(crate) fn remember(context: &Context, color: Color32) {
    context.data_mut(|data| {
        let known: &mut Vec<Color32> = data.get_temp_mut_or_default(id());
        known.retain(|other| *other != color);
        known.insert(0, color);
        known.truncate(MOST_SWATCHES);
    });
}

/// Colors that were picked, the last one first.
fn remembered(context: &Context) -> Vec<Color32> {
    context.data(|data| data.get_temp(id())).unwrap_or_default() // Nothing was picked yet.
}

fn id() -> Id {
    Id::new("colors that were picked")
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    #[test]
    fn numbers_are_those_of_the_encoded_color() {
        // By the definition of Smith 1978: value is the largest part, saturation the share that the smallest lacks to it.
        for (code, parts) in [
            ([160, 101, 63], [23.5, 60.6, 62.7]),
            ([0, 255, 0], [120.0, 100.0, 100.0]),
            ([107, 58, 30], [21.8, 72.0, 42.0]),
            ([128, 128, 128], [0.0, 0.0, 50.2]),
        ] {
            let [hue, saturation, value] = hsv_of(code);
            let told = [hue * 360.0, saturation * 100.0, value * 100.0];
            for (told, part) in told.iter().zip(parts) {
                assert!((told - part).abs() < 0.06, "{code:?}: {told} {part}");
            }
            assert_eq!(srgb_of([hue, saturation, value]), code);
        }
    }

    #[test]
    fn a_typed_number_does_not_scroll_the_panel_below() {
        let show = |ui: &mut Ui, (picked, offset): &mut (Hsva, f32)| {
            let panel = ScrollArea::vertical().max_height(150.0).show(ui, |ui| {
                egui::Area::new("picker".into())
                    .fixed_pos([20.0, 200.0])
                    .show(ui.ctx(), |ui| picker(ui, picked));
                ui.allocate_space(vec2(100.0, 2000.0));
            });
            *offset = panel.state.offset.y;
        };
        let mut board = Harness::builder().build_ui_state(show, (Hsva::from_srgb([160, 101, 63]), 0.0));
        board.get_by_label("Saturation").click();
        board.run();
        board.event(egui::Event::Text("20".into()));
        board.key_press(egui::Key::Enter);
        board.run();
        let (picked, offset) = board.state();
        assert!((hsv_of(picked.to_srgb())[1] - 0.2).abs() < 0.01, "{picked:?}");
        assert_eq!(*offset, 0.0);
    }

    #[test]
    fn the_last_colors_are_offered_once_each_the_last_first() {
        let context = Context::default();
        assert!(remembered(&context).is_empty());
        let gray = |shade: usize| Color32::from_gray(shade as u8);
        for shade in (0..20).chain([5]) {
            remember(&context, gray(shade));
        }
        let known = remembered(&context);
        assert_eq!(known.len(), MOST_SWATCHES);
        assert_eq!(known[..3], [gray(5), gray(19), gray(18)]);
        assert_eq!(known.iter().filter(|color| **color == gray(5)).count(), 1);
    }
}
