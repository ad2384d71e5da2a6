//! Graphs and node files that were not saved when the program last ended: their dates and sizes, and drawings of the graphs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use egui::{Rect, RichText, ScrollArea, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, WidgetType, pos2, vec2};
use sabi_engine::catalog::Catalog;
use sabi_engine::session::Recovery;
use sabi_graph::{Document, Node};
use sabi_nodes::label_of;

use crate::action::{Action, FileAction, Next};
use crate::context::ViewContext;
use crate::paths::file_stem;
use crate::theme::{Theme, space, type_size};

/// Size of a drawing, points.
const DRAWING: Vec2 = vec2(132.0, 76.0);
/// Size of a node in a drawing, canvas points.
const NODE: [f32; 2] = [160.0, 90.0];
/// Points of a drawing for each canvas point, at most: a single node does not fill it.
const LARGEST_SCALE: f32 = 0.25;
/// Most height of the rows, points; more of them are scrolled.
const MOST_HEIGHT: f32 = 240.0;
/// Most names of nodes in the text about a graph.
const MOST_NAMES: usize = 4;

/// Rows of unsaved work that can be recovered.
#[derive(Default)]
pub(super) struct RecoveryList {
    /// Drawings of the graphs, in the order of the rows, with the files that they were made of.
    drawings: Vec<(PathBuf, Option<GraphDrawing>)>,
}

/// A graph as rectangles and lines, and in words.
struct GraphDrawing {
    /// Nodes, on the canvas.
    nodes: Vec<Rect>,
    /// Wires, as the indices of their nodes.
    wires: Vec<[usize; 2]>,
    words: String,
}

impl RecoveryList {
    /// Shows the rows. Returns the action of a clicked button.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) -> Option<Action> {
        if context.recoveries.is_empty() {
            return None;
        }
        let drawn = self.drawings.iter().map(|(path, _)| path.as_path());
        if !drawn.eq(context.recoveries.iter().map(Recovery::path)) {
            let drawing = |recovery: &Recovery| {
                let graph = recovery.document();
                (
                    recovery.path().to_owned(),
                    graph
                        .as_ref()
                        .map(|graph| GraphDrawing::new(graph, context.document.catalog())),
                )
            };
            self.drawings = context.recoveries.iter().map(drawing).collect();
        }
        let theme = context.theme;
        let mut chosen = None;
        ui.colored_label(theme.warning, "The program ended before this was saved:");
        // There is a row for each session that ended; the limited height keeps the contents below in view.
        let rows = ScrollArea::vertical()
            .max_height(MOST_HEIGHT)
            .auto_shrink([false, true]);
        rows.show(ui, |ui| {
            for (at, (recovery, (_, drawing))) in context.recoveries.iter().zip(&self.drawings).enumerate() {
                ui.horizontal(|ui| {
                    if let Some(drawing) = drawing {
                        drawing.show(ui, theme);
                    }
                    ui.vertical(|ui| chosen = row(ui, theme, at, recovery, drawing, actions).or(chosen.take()));
                });
                ui.add_space(space::USUAL);
            }
        });
        ui.add_space(space::WIDE);
        chosen
    }
}

/// Shows a description of unsaved work, and the buttons for it. Returns the action of a clicked one.
fn row(
    ui: &mut Ui,
    theme: &Theme,
    at: usize,
    recovery: &Recovery,
    drawing: &Option<GraphDrawing>,
    actions: &mut Vec<Action>,
) -> Option<Action> {
    if let Some(fault) = recovery.fault() {
        ui.colored_label(theme.fault, fault.to_string());
    } else {
        if recovery.has_graph() {
            let own = recovery.file();
            ui.label(own.map_or("a graph without a file".to_owned(), |file| file.display().to_string()));
        }
        for draft in recovery.drafts() {
            ui.label(format!("the node file {}", draft.id));
        }
    }
    if let Some(drawing) = drawing {
        ui.colored_label(theme.quiet, &drawing.words);
    }
    ui.colored_label(theme.quiet, dates_text(recovery));
    if recovery.is_file_changed() {
        let text = "The file was written by another program since; saving asks before it is replaced.";
        ui.label(RichText::new(text).color(theme.warning).size(type_size::SMALL));
    }
    let mut chosen = None;
    ui.horizontal(|ui| {
        if recovery.fault().is_none() && ui.button("Recover").clicked() {
            chosen = Some(Action::File(FileAction::Ask(Next::Recover(at))));
        }
        ui.menu_button("Discard", |ui| {
            ui.label("It cannot be brought back.");
            if ui.button("Discard permanently").clicked() {
                actions.push(Action::File(FileAction::DeleteRecovery(at)));
            }
        });
    });
    chosen
}

impl GraphDrawing {
    fn new(graph: &Document, catalog: &Catalog) -> GraphDrawing {
        let nodes: Vec<_> = graph.graph.nodes().collect();
        let places: BTreeMap<&str, usize> = (0..).zip(&nodes).map(|(at, (id, _))| (id.as_str(), at)).collect();
        let mut wires = Vec::new();
        for (into, (id, _)) in nodes.iter().enumerate() {
            let inputs = graph.graph.inputs(id.as_str());
            let from = inputs.into_values().filter_map(|from| places.get(from.node.as_str()));
            wires.extend(from.map(|from| [*from, into]));
        }
        let names = nodes.iter().map(|(_, node)| title_of(node, catalog));
        let mut words = match nodes.len() {
            0 => "no nodes".to_owned(),
            1 => "1 node".to_owned(),
            several => format!("{several} nodes"),
        };
        if !nodes.is_empty() {
            let said: Vec<String> = names.take(MOST_NAMES).collect();
            let more = if nodes.len() > MOST_NAMES { ", …" } else { "" };
            words = format!("{words}: {}{more}", said.join(", "));
        }
        let rect = |[x, y]: [f32; 2]| Rect::from_min_size(pos2(x, y), NODE.into());
        GraphDrawing {
            nodes: nodes.iter().map(|(_, node)| rect(node.pos)).collect(),
            wires,
            words,
        }
    }

    fn show(&self, ui: &mut Ui, theme: &Theme) {
        let (place, response) = ui.allocate_exact_size(DRAWING, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Drawing of the graph"));
        let painter = ui.painter().with_clip_rect(place);
        painter.rect(
            place,
            space::CORNER,
            theme.panel,
            Stroke::new(1.0, theme.line),
            StrokeKind::Inside,
        );
        let all = self.nodes.iter().fold(Rect::NOTHING, |all, node| all.union(*node));
        // Positions of a damaged file may be too far apart for a drawing.
        let scale = ((place.size() / all.size()).min_elem() * 0.9).min(LARGEST_SCALE);
        if !scale.is_finite() || scale <= 0.0 {
            return;
        }
        let shown = |rect: &Rect| {
            let middle = place.center() + (rect.center() - all.center()) * scale;
            Rect::from_center_size(middle, rect.size() * scale)
        };
        for [from, into] in &self.wires {
            let line = [
                shown(&self.nodes[*from]).right_center(),
                shown(&self.nodes[*into]).left_center(),
            ];
            painter.line_segment(line, Stroke::new(1.0, theme.quiet));
        }
        for node in &self.nodes {
            painter.rect_filled(shown(node), 1.0, theme.accent);
        }
    }
}

/// Title of a node as the canvas shows it, as far as it is known without the group files of the graph.
fn title_of(node: &Node, catalog: &Catalog) -> String {
    let of_group = || Some(label_of(&file_stem(Path::new(node.group.as_ref()?))));
    let of_kind = || catalog.entry(&node.kind).map(|entry| entry.label.clone());
    let plain = || label_of(node.kind.rsplit('/').next().unwrap_or(&node.kind));
    let own = node.label.clone();
    own.or_else(of_group).or_else(of_kind).unwrap_or_else(plain)
}

/// Ages and sizes of the recovered work and of the file that it belongs to, which show which one is newer.
pub(super) fn dates_text(recovery: &Recovery) -> String {
    let with_size = |age: String, bytes: Option<u64>| match bytes {
        Some(bytes) => format!("{age}, {}", size_text(bytes)),
        None => age,
    };
    let recovered = with_size(
        recovery.when().map_or_else(String::new, age_text),
        recovery.graph_bytes(),
    );
    match recovery.file().and_then(saved) {
        Some((when, bytes)) => format!(
            "unsaved work from {recovered}; the file was saved {}",
            with_size(age_text(when), Some(bytes))
        ),
        None => recovered,
    }
}

/// Time at which a file was written, and its size.
fn saved(file: &Path) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(file).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// Age of something, for people.
fn age_text(when: SystemTime) -> String {
    let minutes = when.elapsed().map_or(0, |age| age.as_secs() / 60);
    match minutes {
        0 => "just now".to_owned(),
        1 => "a minute ago".to_owned(),
        2..120 => format!("{minutes} minutes ago"),
        120..2880 => format!("{} hours ago", minutes / 60),
        _ => format!("{} days ago", minutes / 1440),
    }
}

/// Size of a file, for people.
fn size_text(bytes: u64) -> String {
    match bytes {
        0..1024 => format!("{bytes} bytes"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

#[cfg(test)]
mod tests {
    use sabi_engine::Kinds;

    use super::*;

    #[test]
    fn a_drawing_has_the_nodes_the_wires_and_the_first_names() {
        let text = r#"{ "format": "sabi", "version": 1, "nodes": {
            "a": { "kind": "noise/simplex", "label": "Grain" }, "b": { "kind": "noise/white", "pos": [400, 0] },
            "c": { "kind": "blend/mask", "inputs": { "above": "a", "below": "b" }, "pos": [800, 0] },
            "d": { "kind": "adjust/auto_levels" }, "e": { "kind": "lost/kind" } } }"#;
        let catalog = Catalog::new(&Kinds::builtin());
        let drawing = GraphDrawing::new(&Document::from_json(text).expect("a graph"), &catalog);
        assert_eq!(
            drawing.words,
            "5 nodes: Grain, White noise, Blend masks, Auto levels, …"
        );
        assert_eq!((drawing.nodes.len(), drawing.wires), (5, vec![[0, 2], [1, 2]]));
        assert_eq!(drawing.nodes[1].min, pos2(400.0, 0.0));
    }

    #[test]
    fn sizes_have_the_unit_that_people_read() {
        for (bytes, text) in [(1023, "1023 bytes"), (1536, "1.5 KiB"), (5 << 20, "5.0 MiB")] {
            assert_eq!(size_text(bytes), text);
        }
    }
}
