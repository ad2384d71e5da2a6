//! Distant lights besides the environment.

use egui::{Button, DragValue, Ui};
use egui_phosphor::regular as icon;
use sabi_view::{Light, LightPlace, MOST_LIGHTS};

use crate::settings::viewport::{LIGHT_HEIGHT_DEGREES, LIGHT_SIZE_DEGREES, LIGHT_STRENGTH, LightSetting, TURN_DEGREES};

fn light_of(light: &LightSetting) -> Light {
    Light {
        place: LightPlace::from_angles(light.turn_degrees, light.height_degrees),
        color: light.color.map(|number| number * light.strength),
        has_shadow: light.has_shadow,
        size_degrees: light.size_degrees,
        follows_camera: light.follows_camera,
    }
}

/// Shows the line of the menu for one light. Returns whether the light is to be removed.
fn row(light: &mut LightSetting, ui: &mut Ui, name: &str) -> bool {
    let mut is_removed = false;
    ui.horizontal(|ui| {
        ui.color_edit_button_rgb(&mut light.color)
            .on_hover_text(format!("Color of {name}"));
        let turn = DragValue::new(&mut light.turn_degrees)
            .range(TURN_DEGREES)
            .prefix("Around ")
            .suffix("°");
        ui.add(turn).on_hover_text("Direction around the model");
        let height = DragValue::new(&mut light.height_degrees)
            .range(LIGHT_HEIGHT_DEGREES)
            .prefix("Above ")
            .suffix("°");
        ui.add(height).on_hover_text("Height above the horizon");
        let strength = DragValue::new(&mut light.strength)
            .range(LIGHT_STRENGTH)
            .speed(0.02)
            .prefix("Strength ");
        ui.add(strength).on_hover_text("Strength");
        ui.checkbox(&mut light.has_shadow, "Shadow");
        let size = DragValue::new(&mut light.size_degrees)
            .range(LIGHT_SIZE_DEGREES)
            .speed(0.1)
            .prefix("Size ")
            .suffix("°");
        ui.add(size)
            .on_hover_text("Angle across the light: the larger, the softer its shadow");
        ui.checkbox(&mut light.follows_camera, "With camera")
            .on_hover_text("The light turns with the camera, as if the model stood on a turntable");
        let remove = ui.button(icon::X).on_hover_text("Remove");
        remove.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("Remove {name}")));
        is_removed = remove.clicked();
    });
    is_removed
}

/// All lights besides the environment.
#[derive(Default)]
pub(crate) struct Lights {
    lights: Vec<LightSetting>,
    /// Rises whenever one of them changes.
    number: u64,
}

impl Lights {
    /// Lights of settings, as many as the viewport can have.
    pub(super) fn new(kept: &[LightSetting]) -> Lights {
        let kept = kept.iter().take(MOST_LIGHTS);
        Lights {
            lights: kept.cloned().map(LightSetting::sanitized).collect(),
            number: 0,
        }
    }

    /// Lights for settings.
    pub(crate) fn kept(&self) -> &[LightSetting] {
        &self.lights
    }

    pub(super) fn number(&self) -> u64 {
        self.number
    }

    pub(super) fn lights(&self) -> Vec<Light> {
        self.lights.iter().map(light_of).collect()
    }

    /// Part of the light menu that sets them.
    pub(super) fn menu(&mut self, ui: &mut Ui) {
        let before = self.lights.clone();
        let mut removed = None;
        for (at, light) in self.lights.iter_mut().enumerate() {
            if row(light, ui, &format!("light {}", at + 1)) {
                removed = Some(at);
            }
        }
        if let Some(at) = removed {
            self.lights.remove(at);
        }
        let is_room = self.lights.len() < MOST_LIGHTS;
        if ui.add_enabled(is_room, Button::new("Add a light")).clicked() {
            self.lights.push(LightSetting::default());
        }
        let is_studio = self.lights == LightSetting::studio();
        if ui.add_enabled(!is_studio, Button::new("Studio lights")).clicked() {
            self.lights = LightSetting::studio();
        }
        self.number += u64::from(self.lights != before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_comes_from_the_direction_of_its_angles() {
        for (turn_degrees, height_degrees, from) in [
            (0.0, 0.0, [0.0, 0.0, 1.0]),
            (90.0, 0.0, [1.0, 0.0, 0.0]),
            (0.0, 90.0, [0.0, 1.0, 0.0]),
            (180.0, -90.0, [0.0, -1.0, 0.0]),
        ] {
            let light = LightSetting {
                turn_degrees,
                height_degrees,
                ..LightSetting::default()
            };
            let LightPlace::Directional(towards) = light_of(&light).place else {
                panic!("a far light")
            };
            let is_near = towards.iter().zip(from).all(|(one, other)| (one - other).abs() < 1e-6);
            assert!(is_near, "{turn_degrees} {height_degrees}: {towards:?}");
        }
    }

    #[test]
    fn lights_out_of_range_are_corrected_and_those_beyond_the_limit_left_out() {
        let wild = LightSetting {
            turn_degrees: f32::NAN,
            height_degrees: 700.0,
            color: [2.0, -1.0, 0.5],
            strength: f32::INFINITY,
            has_shadow: false,
            size_degrees: -5.0,
            follows_camera: true,
        };
        let lights = Lights::new(&vec![wild; 9]);
        assert_eq!(lights.kept().len(), MOST_LIGHTS);
        let expected = LightSetting {
            height_degrees: 90.0,
            color: [1.0, 0.0, 0.5],
            has_shadow: false,
            size_degrees: 0.0,
            follows_camera: true,
            ..LightSetting::default()
        };
        assert_eq!(lights.kept()[0], expected);
    }
}
