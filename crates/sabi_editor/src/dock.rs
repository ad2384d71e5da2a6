//! Panels, and where in the window they are.

use std::collections::BTreeMap;

use egui::{CentralPanel, Frame, Id, Rect, Response, Sense, Ui, Vec2, WidgetInfo, WidgetText, WidgetType};
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
    Timing,
    Page,
}

impl Panel {
    /// All panels, in the order in which keys step through them.
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
        Panel::Timing,
        Panel::Page,
    ];

    /// Title of its tab.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Panel::Canvas => "Graph",
            Panel::Viewport => "3D view",
            Panel::Flat => "2D view",
            Panel::Parameters => "Parameters",
            Panel::Stack => "Layers",
            Panel::Library => "Library",
            Panel::Export => "Export",
            Panel::History => "History",
            Panel::Problems => "Problems",
            Panel::Timing => "Timing",
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
            Panel::Timing => icon::GAUGE,
            Panel::Page => icon::BOOK_OPEN_TEXT,
        }
    }
}

/// Arrangement of the panels.
pub(crate) type Layout = Tree<Panel>;

/// Arrangement of the panels for a kind of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Workspace {
    /// A large model beside the graph: the layout of a new installation.
    Material,
    /// The model above the texture, both beside the graph.
    Texture,
    /// The model and the texture beside each other, with brush and layers.
    Paint,
    /// The model alone, with its parameters.
    Look,
}

/// Tabs of a part of the window, the first one in front.
type Tabs = &'static [Panel];

/// Panels at the right of most workspaces, above and below.
const KNOBS: Tabs = &[Panel::Parameters, Panel::Stack, Panel::Export];
const MORE: Tabs = &[
    Panel::Library,
    Panel::History,
    Panel::Problems,
    Panel::Timing,
    Panel::Page,
];

impl Workspace {
    /// All workspaces with their titles.
    pub(crate) const ALL: [(Workspace, &'static str); 4] = [
        (Workspace::Material, "Material"),
        (Workspace::Texture, "Texture"),
        (Workspace::Paint, "Paint"),
        (Workspace::Look, "Look"),
    ];

    /// Sentence about its panels.
    pub(crate) fn about(self) -> &'static str {
        match self {
            Workspace::Material => "A large model beside the graph",
            Workspace::Texture => "The model above its texture, beside the graph",
            Workspace::Paint => "The model and its texture, with the brush and the layers",
            Workspace::Look => "The model alone, with its parameters",
        }
    }

    /// Columns of the window, each with its share of the width, and its rows with their shares of the height.
    fn columns(self) -> Vec<(f32, Vec<(f32, Tabs)>)> {
        let right = |share: f32| (share, vec![(0.62, KNOBS), (0.38, MORE)]);
        let one = |share: f32, tabs: Tabs| (share, vec![(1.0, tabs)]);
        match self {
            Workspace::Material => vec![
                one(0.41, &[Panel::Viewport, Panel::Flat]),
                one(0.38, &[Panel::Canvas]),
                right(0.21),
            ],
            Workspace::Texture => vec![
                (0.34, vec![(0.64, &[Panel::Viewport]), (0.36, &[Panel::Flat])]),
                one(0.45, &[Panel::Canvas]),
                right(0.21),
            ],
            Workspace::Paint => vec![
                one(0.46, &[Panel::Viewport]),
                one(0.31, &[Panel::Flat, Panel::Canvas]),
                (
                    0.23,
                    vec![
                        (0.62, &[Panel::Parameters]),
                        (
                            0.38,
                            &[
                                Panel::Stack,
                                Panel::Library,
                                Panel::History,
                                Panel::Export,
                                Panel::Problems,
                                Panel::Timing,
                                Panel::Page,
                            ],
                        ),
                    ],
                ),
            ],
            Workspace::Look => vec![one(0.77, &[Panel::Viewport, Panel::Flat, Panel::Canvas]), right(0.23)],
        }
    }

    /// The panels as this workspace arranges them.
    fn layout(self) -> Layout {
        let mut tiles = Tiles::default();
        let columns: Vec<(TileId, f32)> = self
            .columns()
            .into_iter()
            .map(|(width, rows)| {
                let rows: Vec<(TileId, f32)> = rows
                    .into_iter()
                    .map(|(height, panels)| {
                        let ids = panels.iter().map(|panel| tiles.insert_pane(*panel)).collect();
                        (tiles.insert_tab_tile(ids), height)
                    })
                    .collect();
                let column = match rows.as_slice() {
                    [(only, _)] => *only,
                    rows => split(&mut tiles, LinearDir::Vertical, rows),
                };
                (column, width)
            })
            .collect();
        let root = split(&mut tiles, LinearDir::Horizontal, &columns);
        Tree::new("panels", root, tiles)
    }
}

/// Layout with only the model and the exposed parameters, for people who never open the graph.
fn use_layout() -> Layout {
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
        // A share of 1 is an equal part of the width or height.
        linear.shares.set_share(*tile, share * count);
    }
    tiles.insert_new(egui_tiles::Tile::Container(Container::Linear(linear)))
}

/// A layout of settings, or the default one where it lacks a panel, as those of older versions may.
fn complete_or_default(layout: Option<Layout>) -> Layout {
    let has_all = |layout: &Layout| layout.root().is_some() && Panel::ALL.iter().all(|panel| has(layout, *panel));
    layout.filter(has_all).unwrap_or_else(|| Workspace::Material.layout())
}

/// Returns whether a layout contains a panel.
fn has(layout: &Layout, panel: Panel) -> bool {
    let mut tiles = layout.tiles.tiles();
    tiles.any(|tile| matches!(tile, egui_tiles::Tile::Pane(known) if *known == panel))
}

/// Brings a panel to the front of its tabs.
fn bring_up(layout: &mut Layout, panel: Panel) {
    layout.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(known) if *known == panel));
}

/// Layout of the panels, and where they were drawn last.
pub(crate) struct Dock {
    layout: Layout,
    /// Layout while only the model and the exposed parameters are shown.
    use_layout: Option<Layout>,
    /// Rectangles of the panels that were drawn in the last frame.
    pub(crate) rects: BTreeMap<Panel, Rect>,
}

impl Dock {
    /// A dock with a layout of settings, if it has every panel.
    pub(crate) fn new(layout: Option<Layout>) -> Dock {
        Dock {
            layout: complete_or_default(layout),
            use_layout: None,
            rects: BTreeMap::new(),
        }
    }

    /// Shows a layout, which may lack panels.
    #[cfg(test)]
    pub(crate) fn set_layout(&mut self, layout: Layout) {
        self.layout = layout;
    }

    /// Layout for settings.
    pub(crate) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Returns whether only the model and the exposed parameters are shown.
    pub(crate) fn is_use_view(&self) -> bool {
        self.use_layout.is_some()
    }

    /// Returns whether a panel was drawn in the last frame.
    pub(crate) fn is_shown(&self, panel: Panel) -> bool {
        self.rects.contains_key(&panel)
    }

    /// Panels that were drawn in the last frame, in their usual order.
    pub(crate) fn shown(&self) -> impl Iterator<Item = Panel> {
        Panel::ALL.into_iter().filter(|panel| self.is_shown(*panel))
    }

    /// Shows only the model and the exposed parameters, or all panels again. Returns whether only those are shown now.
    pub(crate) fn toggle_use_view(&mut self) -> bool {
        self.use_layout = match self.use_layout.take() {
            Some(_) => None,
            None => Some(use_layout()),
        };
        self.is_use_view()
    }

    /// Arranges the panels as a workspace has them.
    pub(crate) fn arrange(&mut self, workspace: Workspace) {
        self.layout = workspace.layout();
        self.use_layout = None;
    }

    /// Brings a panel to the front. The view of model and parameters ends where it does not have the panel.
    pub(crate) fn bring_up(&mut self, panel: Panel) {
        match &mut self.use_layout {
            Some(layout) if has(layout, panel) => bring_up(layout, panel),
            _ => {
                self.use_layout = None;
                bring_up(&mut self.layout, panel);
            }
        }
    }

    /// Draws the panels: `contents` draws the contents of one.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        problems: usize,
        contents: &mut dyn FnMut(&mut Ui, Panel),
    ) {
        let Dock {
            layout,
            use_layout,
            rects,
        } = self;
        rects.clear();
        let mut docked = PanelTabs {
            theme,
            problems,
            contents: &mut |ui, panel| {
                rects.insert(panel, ui.max_rect());
                anchor(ui, panel);
                match panel {
                    Panel::Canvas | Panel::Viewport => contents(ui, panel),
                    _ => padded(ui, theme, |ui| contents(ui, panel)),
                }
            },
        };
        // The window is cleared to the color of the lines between the panels.
        CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            use_layout.as_mut().unwrap_or(layout).ui(&mut docked, ui);
        });
    }
}

/// Id of the anchor that has the keyboard focus after a panel was chosen by a key. Tab leads from it to the panel's
/// first widget.
pub(crate) fn anchor_id(panel: Panel) -> Id {
    Id::new(("keys are for", panel))
}

/// Place at the corner of a panel that can have the keyboard focus. The canvas has a focus of its own.
fn anchor(ui: &Ui, panel: Panel) {
    if panel != Panel::Canvas {
        let corner = Rect::from_min_size(ui.max_rect().min, Vec2::ZERO);
        let anchor = ui.interact(corner, anchor_id(panel), Sense::focusable_noninteractive());
        anchor.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, panel.title()));
    }
}

/// Draws a panel with a margin around its contents.
fn padded(ui: &mut Ui, theme: &Theme, contents: impl FnOnce(&mut Ui)) {
    Frame::new().fill(theme.panel).inner_margin(8).show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        contents(ui);
    });
}

/// Draws the tabs of panels and their contents.
struct PanelTabs<'a> {
    theme: &'a Theme,
    /// Number of problems, which the tab of that panel shows.
    problems: usize,
    contents: &'a mut dyn FnMut(&mut Ui, Panel),
}

impl egui_tiles::Behavior<Panel> for PanelTabs<'_> {
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
        // The tab only paints its title; assistive technology needs it as a label.
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
        self.theme.background
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
            self.theme.background
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

    fn panels(layout: &Layout) -> Vec<Panel> {
        let panes = layout.tiles.tiles().filter_map(|tile| match tile {
            egui_tiles::Tile::Pane(panel) => Some(*panel),
            egui_tiles::Tile::Container(_) => None,
        });
        let mut panels: Vec<Panel> = panes.collect();
        panels.sort();
        panels
    }

    #[test]
    fn every_workspace_has_every_panel_once_and_an_incomplete_layout_is_replaced() {
        let mut all = Panel::ALL.to_vec();
        all.sort();
        for (workspace, title) in Workspace::ALL {
            assert_eq!(panels(&workspace.layout()), all, "{title}");
            let shares: f32 = workspace.columns().iter().map(|(share, _)| share).sum();
            assert!((shares - 1.0).abs() < 1e-6, "{title}: {shares}");
        }
        assert_eq!(panels(&complete_or_default(Some(use_layout()))), all);
    }

    #[test]
    fn a_layout_is_unchanged_after_it_was_saved_as_text() {
        let layout = Workspace::Material.layout();
        let text = serde_json::to_string(&layout).expect("text");
        let read: Layout = serde_json::from_str(&text).expect("a layout");
        assert_eq!(read.root(), layout.root());
    }
}
