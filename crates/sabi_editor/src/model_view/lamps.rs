//! Lights besides the environment: far ones, as the sun is.

use egui::{Button, DragValue, Ui};
use egui_phosphor::regular as icon;
use sabi_engine::view::{Light, LightPlace, MOST_LIGHTS};

use super::choices::{TURN_DEGREES, within};

/// Limits of what the menu sets.
const HEIGHT_DEGREES: std::ops::RangeInclusive<f32> = -90.0..=90.0;
const STRENGTH: std::ops::RangeInclusive<f32> = 0.0..=20.0;

/// One light as it is chosen and kept.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct Lamp {
    /// Where it comes from: around the model, and above it.
    turn_degrees: f32,
    height_degrees: f32,
    /// Linear, 0..1.
    color: [f32; 3],
    strength: f32,
    has_shadow: bool,
}

impl Default for Lamp {
    /// From the left and above, as in the usual studio.
    fn default() -> Lamp {
        Lamp {
            turn_degrees: -40.0,
            height_degrees: 35.0,
            color: [1.0; 3],
            strength: 2.0,
            has_shadow: true,
        }
    }
}

impl Lamp {
    /// What of it can be used: files of settings may have been written by hand.
    fn sound(self) -> Lamp {
        let usual = Lamp::default();
        Lamp {
            turn_degrees: within(self.turn_degrees, &TURN_DEGREES, usual.turn_degrees),
            height_degrees: within(self.height_degrees, &HEIGHT_DEGREES, usual.height_degrees),
            color: self.color.map(|number| within(number, &(0.0..=1.0), 1.0)),
            strength: within(self.strength, &STRENGTH, usual.strength),
            has_shadow: self.has_shadow,
        }
    }

    fn light(&self) -> Light {
        Light {
            place: LightPlace::far_at(self.turn_degrees, self.height_degrees),
            color: self.color.map(|number| number * self.strength),
            has_shadow: self.has_shadow,
        }
    }

    /// One line of the menu; says whether the light shall go.
    fn show(&mut self, ui: &mut Ui, name: &str) -> bool {
        let mut is_gone = false;
        ui.horizontal(|ui| {
            ui.color_edit_button_rgb(&mut self.color)
                .on_hover_text(format!("Color of {name}"));
            let turn = DragValue::new(&mut self.turn_degrees).range(TURN_DEGREES).suffix("°");
            ui.add(turn).on_hover_text("Around the model");
            let height = DragValue::new(&mut self.height_degrees)
                .range(HEIGHT_DEGREES)
                .suffix("°");
            ui.add(height).on_hover_text("Above the model");
            let strength = DragValue::new(&mut self.strength).range(STRENGTH).speed(0.02);
            ui.add(strength).on_hover_text("Strength");
            ui.checkbox(&mut self.has_shadow, "Shadow");
            let remove = ui.button(icon::X).on_hover_text("Remove");
            remove.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("Remove {name}")));
            is_gone = remove.clicked();
        });
        is_gone
    }
}

/// All lights besides the environment.
#[derive(Default)]
pub(crate) struct Lamps {
    lamps: Vec<Lamp>,
    /// Another number whenever one of them has changed.
    number: u64,
}

impl Lamps {
    /// Those that were kept, as far as they can be used.
    pub(super) fn new(kept: &[Lamp]) -> Lamps {
        let kept = kept.iter().take(MOST_LIGHTS);
        Lamps {
            lamps: kept.cloned().map(Lamp::sound).collect(),
            number: 0,
        }
    }

    /// What is to be kept.
    pub(crate) fn kept(&self) -> &[Lamp] {
        &self.lamps
    }

    pub(super) fn number(&self) -> u64 {
        self.number
    }

    pub(super) fn lights(&self) -> Vec<Light> {
        self.lamps.iter().map(Lamp::light).collect()
    }

    /// The part of the menu that sets them.
    pub(super) fn menu(&mut self, ui: &mut Ui) {
        let before = self.lamps.clone();
        let mut gone = None;
        for (at, lamp) in self.lamps.iter_mut().enumerate() {
            if lamp.show(ui, &format!("light {}", at + 1)) {
                gone = Some(at);
            }
        }
        if let Some(at) = gone {
            self.lamps.remove(at);
        }
        let is_room = self.lamps.len() < MOST_LIGHTS;
        if ui.add_enabled(is_room, Button::new("Add a light")).clicked() {
            self.lamps.push(Lamp::default());
        }
        self.number += u64::from(self.lamps != before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_comes_from_where_its_angles_say() {
        for (turn_degrees, height_degrees, from) in [
            (0.0, 0.0, [0.0, 0.0, 1.0]),
            (90.0, 0.0, [1.0, 0.0, 0.0]),
            (0.0, 90.0, [0.0, 1.0, 0.0]),
            (180.0, -90.0, [0.0, -1.0, 0.0]),
        ] {
            let lamp = Lamp {
                turn_degrees,
                height_degrees,
                ..Lamp::default()
            };
            let LightPlace::Far(towards) = lamp.light().place else {
                panic!("a far light")
            };
            let is_near = towards.iter().zip(from).all(|(one, other)| (one - other).abs() < 1e-6);
            assert!(is_near, "{turn_degrees} {height_degrees}: {towards:?}");
        }
    }

    #[test]
    fn lights_that_nobody_can_have_meant_are_mended_and_those_too_many_left_out() {
        let wild = Lamp {
            turn_degrees: f32::NAN,
            height_degrees: 700.0,
            color: [2.0, -1.0, 0.5],
            strength: f32::INFINITY,
            has_shadow: false,
        };
        let lamps = Lamps::new(&vec![wild; 9]);
        assert_eq!(lamps.kept().len(), MOST_LIGHTS);
        let expected = Lamp {
            height_degrees: 90.0,
            color: [1.0, 0.0, 0.5],
            has_shadow: false,
            ..Lamp::default()
        };
        assert_eq!(lamps.kept()[0], expected);
    }
}
