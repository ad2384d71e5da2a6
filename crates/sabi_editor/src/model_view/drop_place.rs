//! Target of a layer that is dropped on the model: the material under the pointer.

use egui::Pos2;
use sabi_editing::dropped_layers::DroppedOn;
use sabi_editing::stack::{self, StackEnd};
use sabi_editing::{OpenDocument, node_paths};
use sabi_engine::catalog::Interface;
use sabi_engine::live::{LiveModel, ViewSubject};
use sabi_graph::PortType;

use super::ModelView;
use super::navigation::picked_by;
use crate::evaluation::Evaluation;

/// Place of the model that a layer is dropped on.
pub(crate) struct DropPlace {
    /// Material there.
    pub(crate) material: DroppedOn,
    /// True if the model has a normal map there; beside the model, if it has one anywhere.
    pub(crate) has_normal_map: bool,
}

impl ModelView {
    /// Place of the model that a node is dropped on; `None` outside of the view, or if the node gives no material.
    pub(crate) fn drop_place(
        &self,
        document: &OpenDocument,
        evaluation: &Evaluation,
        shown: &ViewSubject,
        interface: &Interface,
        at: Pos2,
    ) -> Option<DropPlace> {
        let gives_material = interface.outputs.iter().any(|port| port.ty == Some(PortType::Material));
        if !gives_material || !self.area.is_some_and(|area| area.contains(at)) {
            return None;
        }
        let main = evaluation.results.picture(shown).or(self.last.as_ref());
        let cell = self.main_cell.filter(|cell| cell.contains(at));
        let of_main = cell.zip(main).map(|(cell, main)| (main, cell, self.navigation.camera));
        let seen = of_main.or_else(|| self.row.seen_at(at));
        let picture = seen.map(|(picture, ..)| picture).or(main);
        let model = picture.map(|picture| &picture.model);
        let picked = seen.and_then(|(picture, cell, camera)| picked_by(&camera, &picture.model, cell, at));
        let (Some(picture), Some(picked)) = (picture, picked) else {
            let has_normal_map = |model: &LiveModel| {
                let mut materials = model.linked.model.materials.iter();
                materials.any(|material| material.normal.is_some())
            };
            return Some(DropPlace {
                material: end_of_shown(document, shown),
                has_normal_map: model.is_some_and(|model| has_normal_map(model)),
            });
        };
        let material = picture.model.linked.model.materials.get(picked.material as usize);
        let name = || {
            let named = material
                .map(|material| material.name.clone())
                .filter(|name| !name.is_empty());
            let mut sets = picture.model.sets.iter();
            named.or_else(|| Some(sets.find(|set| set.key.material == picked.material)?.name.clone()))
        };
        let output = picture.outputs.get(&picked.material);
        Some(DropPlace {
            material: match output.map(|output| node_paths::in_shown_graph(document, output)) {
                Some(Some(output)) => DroppedOn::Output(StackEnd::Node(output)),
                // The output is in another graph than the one on the canvas.
                Some(None) => end_of_shown(document, shown),
                None => name().map_or_else(|| end_of_shown(document, shown), DroppedOn::Material),
            },
            has_normal_map: material.is_some_and(|material| material.normal.is_some()),
        })
    }
}

/// The only stack of the shown graph that has the shown node as a layer.
fn end_of_shown(document: &OpenDocument, shown: &ViewSubject) -> DroppedOn {
    let ViewSubject::Node(result) = shown else {
        return DroppedOn::Unknown;
    };
    let node = node_paths::in_shown_graph(document, &result.node);
    let stacks = stack::all(document).into_iter();
    let mut with_it = stacks.filter(|stack| stack.layers.iter().any(|layer| Some(&layer.node) == node.as_ref()));
    match (with_it.next(), with_it.next()) {
        (Some(stack), None) => DroppedOn::Output(stack.end),
        _ => DroppedOn::Unknown,
    }
}
