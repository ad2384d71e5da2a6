//! Panels and where they are.

use egui::{Response, Ui, WidgetInfo, WidgetText, WidgetType};
use egui_phosphor::regular as icon;
use egui_tiles::{Container, Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse};

use crate::theme::Theme;

/// A panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Panel {
    Canvas,
    Viewport,
    Flat,
    Parameters,
    Stack,
    Library,
    Export,
    History,
    Problems,
    Performance,
    Page,
}

impl Panel {
    /// All of them.
    pub(crate) const ALL: [Panel; 11] = [
        Panel::Viewport,
        Panel::Flat,
        Panel::Canvas,
        Panel::Parameters,
        Panel::Stack,
        Panel::Library,
        Panel::Export,
        Panel::History,
        Panel::Problems,
        Panel::Performance,
        Panel::Page,
    ];

    /// What it is called.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Panel::Canvas => "Graph",
            Panel::Viewport => "Model",
            Panel::Flat => "Texture",
            Panel::Parameters => "Parameters",
            Panel::Stack => "Layers",
            Panel::Library => "Library",
            Panel::Export => "Export",
            Panel::History => "History",
            Panel::Problems => "Problems",
            Panel::Performance => "Performance",
            Panel::Page => "Node page",
        }
    }

    fn icon(self) -> &'static str {
        match self {
            Panel::Canvas => icon::GRAPH,
            Panel::Viewport => icon::CUBE,
            Panel::Flat => icon::IMAGE_SQUARE,
            Panel::Parameters => icon::SLIDERS_HORIZONTAL,
            Panel::Stack => icon::STACK,
            Panel::Library => icon::BOOKS,
            Panel::Export => icon::EXPORT,
            Panel::History => icon::CLOCK_COUNTER_CLOCKWISE,
            Panel::Problems => icon::WARNING,
            Panel::Performance => icon::GAUGE,
            Panel::Page => icon::BOOK_OPEN_TEXT,
        }
    }
}

/// Where panels are.
pub(crate) type Layout = Tree<Panel>;

/// Where panels are in a new installation: the model and the texture on the left, the graph in the middle.
pub(crate) fn default_layout() -> Layout {
    let mut tiles = Tiles::default();
    let mut tabs = |panels: &[Panel]| {
        let ids: Vec<TileId> = panels.iter().map(|panel| tiles.insert_pane(*panel)).collect();
        tiles.insert_tab_tile(ids)
    };
    let model = tabs(&[Panel::Viewport]);
    let flat = tabs(&[Panel::Flat]);
    let graph = tabs(&[Panel::Canvas]);
    let knobs = tabs(&[Panel::Parameters, Panel::Stack, Panel::Export]);
    let more = tabs(&[
        Panel::Library,
        Panel::History,
        Panel::Problems,
        Panel::Performance,
        Panel::Page,
    ]);
    let left = split(&mut tiles, LinearDir::Vertical, &[(model, 0.64), (flat, 0.36)]);
    let right = split(&mut tiles, LinearDir::Vertical, &[(knobs, 0.62), (more, 0.38)]);
    let root = split(
        &mut tiles,
        LinearDir::Horizontal,
        &[(left, 0.34), (graph, 0.45), (right, 0.21)],
    );
    Tree::new("panels", root, tiles)
}

/// Only the model and the knobs, for people who never open the graph.
pub(crate) fn use_layout() -> Layout {
    let mut tiles = Tiles::default();
    let model = tiles.insert_pane(Panel::Viewport);
    let knobs = tiles.insert_pane(Panel::Parameters);
    let export = tiles.insert_pane(Panel::Export);
    let right = split(&mut tiles, LinearDir::Vertical, &[(knobs, 0.6), (export, 0.4)]);
    let root = split(&mut tiles, LinearDir::Horizontal, &[(model, 0.74), (right, 0.26)]);
    Tree::new("use", root, tiles)
}

fn split(tiles: &mut Tiles<Panel>, dir: LinearDir, parts: &[(TileId, f32)]) -> TileId {
    let mut linear = Linear::new(dir, parts.iter().map(|(tile, _)| *tile).collect());
    let count = parts.len() as f32;
    for (tile, share) in parts {
        // Shares are counted against 1 for each part.
        linear.shares.set_share(*tile, share * count);
    }
    tiles.insert_new(egui_tiles::Tile::Container(Container::Linear(linear)))
}

/// A layout that has every panel that a new version knows; the default one where it does not.
pub(crate) fn sound(layout: Option<Layout>) -> Layout {
    let has_all = |layout: &Layout| layout.root().is_some() && Panel::ALL.iter().all(|panel| has(layout, *panel));
    layout.filter(has_all).unwrap_or_else(default_layout)
}

/// Whether a panel is in a layout.
pub(crate) fn has(layout: &Layout, panel: Panel) -> bool {
    let mut tiles = layout.tiles.tiles();
    tiles.any(|tile| matches!(tile, egui_tiles::Tile::Pane(known) if *known == panel))
}

/// Brings a panel to the front.
pub(crate) fn bring_up(layout: &mut Layout, panel: Panel) {
    layout.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(known) if *known == panel));
}

/// Draws panels by asking for what is in them.
pub(crate) struct Docked<'a> {
    pub(crate) theme: &'a Theme,
    /// Badges on tabs: how many problems there are.
    pub(crate) problems: usize,
    pub(crate) contents: &'a mut dyn FnMut(&mut Ui, Panel),
}

impl egui_tiles::Behavior<Panel> for Docked<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, panel: &mut Panel) -> UiResponse {
        (self.contents)(ui, *panel);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, panel: &Panel) -> WidgetText {
        let badge = match (panel, self.problems) {
            (Panel::Problems, count @ 1..) => format!(" {count}"),
            _ => String::new(),
        };
        format!("{} {}{badge}", panel.icon(), panel.title()).into()
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<Panel>, tile: TileId, response: Response) -> Response {
        // The title is only painted; it is told to those who do not see it.
        if let Some(panel) = tiles.get_pane(&tile) {
            let count = format!("{} {}", panel.title(), self.problems);
            let has_count = *panel == Panel::Problems && self.problems > 0;
            let name = if has_count { count.as_str() } else { panel.title() };
            response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
        }
        response
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions {
            all_panes_must_have_tabs: true,
            ..SimplificationOptions::default()
        }
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        26.0
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        3.0
    }

    fn tab_bar_color(&self, _: &egui::Visuals) -> egui::Color32 {
        self.theme.ground
    }

    fn tab_bg_color(
        &self,
        _: &egui::Visuals,
        _: &Tiles<Panel>,
        _: TileId,
        state: &egui_tiles::TabState,
    ) -> egui::Color32 {
        if state.active {
            self.theme.panel
        } else {
            self.theme.ground
        }
    }

    fn tab_text_color(
        &self,
        _: &egui::Visuals,
        _: &Tiles<Panel>,
        _: TileId,
        state: &egui_tiles::TabState,
    ) -> egui::Color32 {
        if state.active {
            self.theme.text
        } else {
            self.theme.quiet
        }
    }

    fn tab_outline_stroke(
        &self,
        _: &egui::Visuals,
        _: &Tiles<Panel>,
        _: TileId,
        _: &egui_tiles::TabState,
    ) -> egui::Stroke {
        egui::Stroke::NONE
    }

    fn tab_bar_hline_stroke(&self, _: &egui::Visuals) -> egui::Stroke {
        egui::Stroke::NONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_panel_is_somewhere_and_a_layout_without_one_is_not_taken() {
        let layout = default_layout();
        let count = layout
            .tiles
            .tiles()
            .filter(|tile| matches!(tile, egui_tiles::Tile::Pane(_)))
            .count();
        assert_eq!(count, Panel::ALL.len());
        let taken = sound(Some(use_layout()));
        let count = taken
            .tiles
            .tiles()
            .filter(|tile| matches!(tile, egui_tiles::Tile::Pane(_)))
            .count();
        assert_eq!(count, Panel::ALL.len());
    }

    #[test]
    fn a_layout_is_kept_as_text() {
        let text = serde_json::to_string(&default_layout()).expect("text");
        let read: Layout = serde_json::from_str(&text).expect("a layout");
        assert_eq!(read.root(), default_layout().root());
    }
}
