//! Undo and redo.

use crate::relocate::{Places, Relocation, may_bring_paths};
use crate::{Document, Edit, EditError};

/// Steps that can be undone at least; beyond, the oldest are forgotten, so that a long day's work takes no more memory than a
/// short one.
pub const UNDO_STEPS: usize = 2000;

/// What was done and can be undone, and what was undone and can be done again. Undo is a stack of inverse edits.
#[derive(Clone, Debug, Default)]
pub struct History {
    undo: Vec<Step>,
    redo: Vec<Step>,
    /// A group of edits in the making.
    open: Option<Step>,
    /// What could be done again before the open group's first edit, and can be if that is canceled.
    put_away: Vec<Step>,
}

/// One entry of a menu: its name, and the edits that take it back (or do it again), in the order to apply them.
#[derive(Clone, Debug)]
struct Step {
    name: String,
    edits: Vec<Edit>,
}

impl History {
    /// An empty history.
    pub fn new() -> Self {
        History::default()
    }

    /// Makes an edit and remembers it under that name, or as part of the open group. What was undone is forgotten.
    ///
    /// # Errors
    /// The edit was refused; nothing changed.
    pub fn apply(&mut self, document: &mut Document, name: &str, edit: Edit) -> Result<(), EditError> {
        let inverse = document.apply(edit)?;
        let undone = std::mem::take(&mut self.redo);
        if self.open.is_some() && !undone.is_empty() {
            self.put_away = undone;
        }
        match &mut self.open {
            // A drag sets the same knob again and again: the first inverse leads back past all of them.
            Some(step) if step.edits.last().is_some_and(|last| sets_the_same(last, &inverse)) => {}
            Some(step) => step.edits.push(inverse),
            None => self.remember(Step {
                name: name.to_owned(),
                edits: vec![inverse],
            }),
        }
        Ok(())
    }

    /// Puts a step on top of those that can be undone.
    fn remember(&mut self, step: Step) {
        self.undo.push(step);
        // Now and then many at once, since those that stay move up.
        if self.undo.len() >= UNDO_STEPS + UNDO_STEPS / 4 {
            self.undo.drain(..UNDO_STEPS / 4);
        }
    }

    /// Opens a group: all edits until [`History::end`] are one step of that name. A group that is open is ended.
    pub fn begin(&mut self, name: &str) {
        self.end();
        self.open = Some(Step {
            name: name.to_owned(),
            edits: Vec::new(),
        });
    }

    /// Ends the open group, if there is one; a group without edits leaves no step.
    pub fn end(&mut self) {
        self.put_away.clear();
        if let Some(mut step) = self.open.take()
            && !step.edits.is_empty()
        {
            // They were made in this order, so they are taken back in the other.
            step.edits.reverse();
            self.remember(step);
        }
    }

    /// Takes back what the open group did, as if it had never been.
    ///
    /// # Errors
    /// The document was changed past this history; it stays as it is.
    pub fn cancel(&mut self, document: &mut Document) -> Result<(), EditError> {
        let Some(mut step) = self.open.take() else {
            return Ok(());
        };
        step.edits.reverse();
        document.apply(Edit::Batch(step.edits))?;
        if !self.put_away.is_empty() {
            self.redo = std::mem::take(&mut self.put_away);
        }
        Ok(())
    }

    /// Takes the last step back; gives its name, or `None` when there is nothing to undo.
    ///
    /// # Errors
    /// The document was changed past this history; it stays as it is.
    pub fn undo(&mut self, document: &mut Document) -> Result<Option<String>, EditError> {
        self.end();
        replay(document, &mut self.undo, &mut self.redo)
    }

    /// Does the last undone step again; gives its name, or `None` when there is nothing to redo.
    ///
    /// # Errors
    /// The document was changed past this history; it stays as it is.
    pub fn redo(&mut self, document: &mut Document) -> Result<Option<String>, EditError> {
        self.end();
        replay(document, &mut self.redo, &mut self.undo)
    }

    /// Follows a document that was written in another folder: undo leads to what was there before, as it is written in the
    /// new folder. `document` is as it was in the old one.
    pub fn relocate(&mut self, document: &Document, relocation: Relocation<'_>) {
        self.end();
        for steps in [&mut self.undo, &mut self.redo] {
            let mut state = document.clone();
            for step in steps.iter_mut().rev() {
                let edit = Edit::Batch(step.edits.clone());
                // What a parameter means is known while its node is there: before the step, or after it.
                let before = may_bring_paths(&edit).then(|| state.clone());
                if state.apply(edit).is_err() {
                    // The document was changed past this history, which undo says.
                    break;
                }
                if let Some(before) = &before {
                    let states = vec![before, &state];
                    let places = Places { relocation, states };
                    step.edits.iter_mut().for_each(|edit| places.edit(edit));
                }
            }
        }
    }

    /// Names of the steps that can be undone, the next one last.
    pub fn undo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.undo.iter().chain(&self.open).map(|step| step.name.as_str())
    }

    /// Names of the steps that can be done again, the next one last.
    pub fn redo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.redo.iter().map(|step| step.name.as_str())
    }
}

/// Whether two edits give new values to the very same places of nodes.
fn sets_the_same(one: &Edit, other: &Edit) -> bool {
    match (one, other) {
        (
            Edit::SetParam { body, node, param, .. },
            Edit::SetParam {
                body: other_body,
                node: other_node,
                param: other_param,
                ..
            },
        ) => (body, node, param) == (other_body, other_node, other_param),
        (
            Edit::Move { body, node, .. },
            Edit::Move {
                body: other_body,
                node: other_node,
                ..
            },
        ) => (body, node) == (other_body, other_node),
        (Edit::Batch(edits), Edit::Batch(others)) => {
            edits.len() == others.len() && edits.iter().zip(others).all(|(edit, other)| sets_the_same(edit, other))
        }
        _ => false,
    }
}

/// Applies the top step of one stack and puts its inverse on the other.
fn replay(document: &mut Document, from: &mut Vec<Step>, to: &mut Vec<Step>) -> Result<Option<String>, EditError> {
    let Some(step) = from.pop() else {
        return Ok(None);
    };
    match document.apply(Edit::Batch(step.edits.clone())) {
        Ok(inverse) => {
            let name = step.name;
            to.push(Step {
                name: name.clone(),
                edits: vec![inverse],
            });
            Ok(Some(name))
        }
        Err(error) => {
            from.push(step);
            Err(error)
        }
    }
}
