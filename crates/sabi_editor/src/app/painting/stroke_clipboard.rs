//! Copies strokes to the clipboard and pastes them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use egui::Ui;
use sabi_editing::command::PaintCommand;
use sabi_editing::painting::{strokes_of, strokes_on};
use sabi_paint::{Step, Stroke, StrokeGroup, strokes_as_text, strokes_from_text};

use super::Painting;

impl Painting<'_> {
    /// Puts strokes on the clipboard as text; their pictures are kept with the brushes, so that other graphs find them.
    pub(super) fn copy_strokes(&mut self, strokes: &[Arc<Stroke>], ui: &Ui) {
        let store = self.edits.documents.strokes();
        for picture in strokes.iter().flat_map(|stroke| stroke.pictures()) {
            let kept = self.edits.documents.brushes.keep_picture(picture, &store);
            self.edits.shell.report(kept);
        }
        ui.ctx().copy_text(strokes_as_text(strokes));
    }

    /// Adds the strokes of a text on top of those of the selected paint node, and marks them.
    pub(super) fn paste_strokes(&mut self, text: &str, ui: &Ui) {
        let document = &self.edits.documents.document;
        let selected = document.selected_one().cloned();
        let target = selected.and_then(|node| Some((strokes_of(document, &node)?, node)));
        let Some((before, node)) = target else {
            self.edits
                .shell
                .notify("Select the Paint node that the strokes are for, then paste them.");
            return;
        };
        let Some(model) = self.evaluation.model.received.as_ref() else {
            self.edits
                .shell
                .notify("Open the model that the strokes are for, then paste them.");
            return;
        };
        let model = model.linked.model.stem.clone();
        let strokes = match strokes_from_text(text) {
            Ok(strokes) => strokes,
            Err(error) => {
                self.edits.shell.notify(error.to_string());
                return;
            }
        };
        let store = self.edits.documents.strokes();
        for picture in strokes.iter().flat_map(|stroke| stroke.pictures()) {
            if store.picture(picture).is_none() {
                let found = self.edits.documents.brushes.find_picture(picture, &store);
                self.edits.shell.report(found);
            }
        }
        let known = strokes_on(&self.edits.documents.document, &node, &model).unwrap_or_default(); // Nothing is painted yet.
        let count = strokes.len();
        let steps = additions(strokes, known.free_group_number());
        let command = PaintCommand::Steps {
            node: node.clone(),
            model: model.clone(),
            before,
            title: "Paste strokes".to_owned(),
            steps,
        };
        self.edits.edit(command, ui);
        self.keep_strokes();
        let list = strokes_on(&self.edits.documents.document, &node, &model).unwrap_or_default(); // Nothing is painted yet.
        let pasted = list.strokes.iter().rev().take(count).map(|stroke| stroke.id);
        self.edits.looks.marked_strokes = pasted.collect::<BTreeSet<_>>();
    }
}

/// Steps that add strokes. Their groups are numbered from `free` on.
fn additions(strokes: Vec<Stroke>, free: u32) -> Vec<Step> {
    let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
    let added = strokes.into_iter().map(|stroke| {
        let group = stroke.group.as_ref().map(|group| {
            let next = free.saturating_add(numbers.len() as u32);
            let number = *numbers.entry(group.number).or_insert(next);
            Arc::new(StrokeGroup {
                number,
                ..(**group).clone()
            })
        });
        Step::Add(Arc::new(Stroke { group, ..stroke }))
    });
    added.collect()
}
