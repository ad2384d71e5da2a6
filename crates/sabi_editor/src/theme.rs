//! Colors, distances and type sizes of the window.

use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, Style, TextStyle, Visuals};
use sabi_graph::PortType;

/// Color scheme of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ColorScheme {
    /// Light on dark, as in most image tools.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

/// Distances in points.
pub(crate) mod space {
    /// Distance between things that belong together.
    pub(crate) const TIGHT: f32 = 4.0;
    /// Usual distance.
    pub(crate) const USUAL: f32 = 8.0;
    /// Distance between groups.
    pub(crate) const WIDE: f32 = 16.0;
    /// Radius of corners.
    pub(crate) const CORNER: u8 = 4;
    /// Height of rows that can be clicked.
    pub(crate) const ROW: f32 = 22.0;
}

/// Sizes of type in points.
pub(crate) mod type_size {
    pub(crate) const SMALL: f32 = 10.5;
    pub(crate) const BODY: f32 = 12.5;
    pub(crate) const HEADING: f32 = 15.0;
    pub(crate) const TITLE: f32 = 24.0;
}

/// Colors of one shade.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Theme {
    /// Shade that the colors are of.
    pub(crate) shade: ColorScheme,
    /// Background of the window.
    pub(crate) background: Color32,
    /// Background of the canvas.
    pub(crate) canvas: Color32,
    /// Lines of the canvas' grid.
    pub(crate) grid: Color32,
    /// Background of panels.
    pub(crate) panel: Color32,
    /// Background of fields, nodes and rows on panels.
    pub(crate) raised: Color32,
    /// Background of a row or field under the pointer.
    pub(crate) hovered: Color32,
    /// Lines.
    pub(crate) line: Color32,
    /// Text.
    pub(crate) text: Color32,
    /// Explaining text.
    pub(crate) quiet: Color32,
    /// Accent: selection and focus.
    pub(crate) accent: Color32,
    /// Text on the accent.
    pub(crate) on_accent: Color32,
    /// Errors.
    pub(crate) fault: Color32,
    /// Warnings, and nodes that wait.
    pub(crate) warning: Color32,
    /// Success.
    pub(crate) good: Color32,
}

/// Seconds that the pointer rests before a tooltip is shown.
const TOOLTIP_DELAY: f32 = 0.7;

impl Theme {
    /// Theme of a shade.
    pub(crate) fn of(shade: ColorScheme) -> Theme {
        match shade {
            ColorScheme::Dark => Theme {
                shade,
                background: rgb(0x17181a),
                canvas: rgb(0x1c1d20),
                grid: rgb(0x27292d),
                panel: rgb(0x212327),
                raised: rgb(0x2c2f34),
                hovered: rgb(0x393d44),
                line: rgb(0x35383e),
                text: rgb(0xdfe1e5),
                quiet: rgb(0x959aa3),
                accent: rgb(0xe07b3c),
                on_accent: rgb(0x1b120b),
                fault: rgb(0xf0616d),
                warning: rgb(0xe6b450),
                good: rgb(0x5fb38a),
            },
            ColorScheme::Light => Theme {
                shade,
                background: rgb(0xd4d6d9),
                canvas: rgb(0xe3e5e8),
                grid: rgb(0xd3d6da),
                panel: rgb(0xf1f2f4),
                raised: rgb(0xffffff),
                hovered: rgb(0xe6e8ec),
                line: rgb(0xc9ccd2),
                text: rgb(0x22252a),
                quiet: rgb(0x5a616c),
                accent: rgb(0xb9501a),
                on_accent: rgb(0xffffff),
                fault: rgb(0xb92637),
                warning: rgb(0x8a5a00),
                good: rgb(0x1f7a4f),
            },
        }
    }

    /// Color of wires and ports. The hues differ for color-blind eyes as well, and ports also differ in shape.
    pub(crate) fn port(&self, ty: Option<PortType>) -> Color32 {
        let [dark, light] = match ty {
            Some(PortType::Mask) => [0xc4c9d1, 0x2f343b],
            Some(PortType::Color) => [0xf2c94c, 0xa87900],
            Some(PortType::Vector) => [0x63b3ee, 0x1a6fb3],
            Some(PortType::Material) => [0x3fbf95, 0x0f7d5b],
            None => [0x8b919b, 0x7a808a],
        };
        rgb(match self.shade {
            ColorScheme::Dark => dark,
            ColorScheme::Light => light,
        })
    }

    /// Color of a node's title, by category.
    pub(crate) fn category(&self, category: &str) -> Color32 {
        let [dark, light] = match category {
            "noise" => [0x3d4f73, 0xb9c8ea],
            "vector" => [0x2f5a73, 0xaed6ec],
            "surface" => [0x4b5b35, 0xcadcae],
            "relief" => [0x5c5632, 0xe0d8a8],
            "filter" => [0x2f5f5c, 0xaadfda],
            "adjust" => [0x474d57, 0xccd1d9],
            "blend" => [0x514466, 0xd3c6ea],
            "color" => [0x6b5420, 0xf0dca0],
            "material" => [0x28604c, 0xa5e0c8],
            "effect" => [0x743f24, 0xf2c2a6],
            "source" => [0x4d4a45, 0xd8d3ca],
            "output" => [0x6b3440, 0xf0b9c3],
            _ => [0x3f4248, 0xd0d3d8],
        };
        rgb(match self.shade {
            ColorScheme::Dark => dark,
            ColorScheme::Light => light,
        })
    }

    /// Applies the theme to the window.
    pub(crate) fn apply(&self, context: &egui::Context) {
        let theme = match self.shade {
            ColorScheme::Dark => egui::Theme::Dark,
            ColorScheme::Light => egui::Theme::Light,
        };
        context.set_theme(theme);
        context.all_styles_mut(|style| self.style(style));
    }

    fn style(&self, style: &mut Style) {
        let of = |size: f32| FontId::new(size, FontFamily::Proportional);
        style.text_styles = [
            (TextStyle::Small, of(type_size::SMALL)),
            (TextStyle::Body, of(type_size::BODY)),
            (TextStyle::Button, of(type_size::BODY)),
            (TextStyle::Heading, of(type_size::HEADING)),
            (
                TextStyle::Monospace,
                FontId::new(type_size::BODY, FontFamily::Monospace),
            ),
        ]
        .into();
        style.spacing.item_spacing = egui::vec2(space::USUAL, space::TIGHT);
        style.spacing.button_padding = egui::vec2(space::USUAL, 3.0);
        style.spacing.interact_size = egui::vec2(40.0, space::ROW);
        style.spacing.window_margin = Margin::same(10);
        style.spacing.menu_margin = Margin::same(6);
        style.interaction.selectable_labels = false;
        // Tooltips wait until the pointer rests for a while.
        style.interaction.tooltip_delay = TOOLTIP_DELAY;
        style.visuals = self.visuals();
    }

    fn visuals(&self) -> Visuals {
        let mut visuals = match self.shade {
            ColorScheme::Dark => Visuals::dark(),
            ColorScheme::Light => Visuals::light(),
        };
        let corner = CornerRadius::same(space::CORNER);
        visuals.panel_fill = self.panel;
        visuals.window_fill = self.panel;
        visuals.window_stroke = Stroke::new(1.0, self.line);
        visuals.window_corner_radius = CornerRadius::same(space::CORNER + 2);
        visuals.menu_corner_radius = corner;
        visuals.extreme_bg_color = self.background;
        visuals.faint_bg_color = self.raised;
        visuals.hyperlink_color = self.accent;
        visuals.warn_fg_color = self.warning;
        visuals.error_fg_color = self.fault;
        visuals.selection.bg_fill = self.accent.gamma_multiply(0.45);
        visuals.selection.stroke = Stroke::new(1.0, self.text);
        visuals.slider_trailing_fill = true;
        let widgets = &mut visuals.widgets;
        let states = [
            (&mut widgets.noninteractive, self.panel, self.text, self.line),
            (&mut widgets.inactive, self.raised, self.text, self.line),
            (&mut widgets.hovered, self.hovered, self.text, self.line),
            (&mut widgets.active, self.hovered, self.text, self.accent),
            (&mut widgets.open, self.hovered, self.text, self.line),
        ];
        for (state, fill, text, line) in states {
            state.bg_fill = fill;
            state.weak_bg_fill = fill;
            state.fg_stroke = Stroke::new(1.0, text);
            state.bg_stroke = Stroke::new(1.0, line);
            state.corner_radius = corner;
            state.expansion = 0.0;
        }
        visuals
    }
}

const fn rgb(code: u32) -> Color32 {
    let [_, red, green, blue] = code.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance after WCAG 2.2.
    fn luminance(color: Color32) -> f32 {
        let linear = egui::Rgba::from(color);
        0.2126 * linear.r() + 0.7152 * linear.g() + 0.0722 * linear.b()
    }

    /// Contrast after WCAG 2.2, 1 to 21.
    fn contrast(one: Color32, other: Color32) -> f32 {
        let [one, other] = [one, other].map(|color| luminance(color) + 0.05);
        one.max(other) / one.min(other)
    }

    #[test]
    fn text_can_be_read_on_every_background_that_it_has() {
        for theme in [ColorScheme::Dark, ColorScheme::Light].map(Theme::of) {
            for behind in [theme.panel, theme.raised, theme.canvas] {
                assert!(contrast(theme.text, behind) > 7.0, "{theme:?}");
                assert!(contrast(theme.quiet, behind) > 4.5, "{:?} {behind:?}", theme.shade);
                assert!(contrast(theme.fault, behind) > 3.0, "{:?} {behind:?}", theme.shade);
            }
            assert!(contrast(theme.on_accent, theme.accent) > 4.5, "{:?}", theme.shade);
            for category in ["noise", "color", "effect", "output", "graph", "adjust"] {
                assert!(
                    contrast(theme.text, theme.category(category)) > 4.5,
                    "{category} {:?}",
                    theme.shade
                );
            }
        }
    }

    /// Color as a deuteranope sees it, after Viénot, Brettel and Mollon 1999, linear.
    fn without_green([r, g, b]: [f32; 3]) -> [f32; 3] {
        [
            0.29275 * r + 0.70725 * g,
            0.29275 * r + 0.70725 * g,
            -0.02234 * r + 0.02234 * g + b,
        ]
    }

    #[test]
    fn ports_of_two_types_never_look_alike_even_without_green() {
        let types = PortType::ALL;
        for theme in [ColorScheme::Dark, ColorScheme::Light].map(Theme::of) {
            for (at, one) in types.iter().enumerate() {
                for other in &types[at + 1..] {
                    let [one_seen, other_seen] = [one, other].map(|ty| {
                        let color = egui::Rgba::from(theme.port(Some(*ty)));
                        without_green([color.r(), color.g(), color.b()])
                    });
                    let apart: f32 = (0..3)
                        .map(|at| (one_seen[at] - other_seen[at]).powi(2))
                        .sum::<f32>()
                        .sqrt();
                    assert!(apart > 0.1, "{one} and {other} are {apart} apart in {:?}", theme.shade);
                }
            }
        }
    }
}
