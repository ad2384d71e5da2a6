//! Undo and redo.

use crate::relocate::{PathRewriter, Relocation, may_bring_paths};
use crate::{Document, Edit, EditError};

/// Minimum number of steps that can be undone. Older steps are dropped to limit memory.
pub const UNDO_STEPS: usize = 2000;

/// Undo and redo as two stacks of inverse edits.
#[derive(Clone, Debug, Default)]
pub struct History {
    undo: Vec<UndoStep>,
    redo: Vec<UndoStep>,
    /// The open group of edits.
    open: Option<UndoStep>,
    /// Redo stack before the first edit of the open group. It is restored when the group is canceled.
    redo_before_group: Vec<UndoStep>,
}

/// One step: its name in menus, and the edits that undo or redo it, in the order to apply them.
#[derive(Clone, Debug)]
struct UndoStep {
    name: String,
    edits: Vec<Edit>,
}

impl History {
    /// An empty history.
    pub fn new() -> Self {
        History::default()
    }

    /// Applies an edit and records it as a step, or as a part of the open group. Clears the redo stack.
    ///
    /// # Errors
    /// The edit was refused; nothing changed.
    pub fn apply(&mut self, document: &mut Document, name: &str, edit: Edit) -> Result<(), EditError> {
        let inverse = document.apply(edit)?;
        let undone = std::mem::take(&mut self.redo);
        if self.open.is_some() && !undone.is_empty() {
            self.redo_before_group = undone;
        }
        if let Some(step) = &mut self.open
            && step.name.is_empty()
        {
            name.clone_into(&mut step.name);
        }
        match &mut self.open {
            // A drag sets the same knob repeatedly. The inverse of the first edit undoes all of them, so later inverses are not recorded.
            Some(step) if step.edits.last().is_some_and(|last| sets_the_same(last, &inverse)) => {}
            Some(step) => step.edits.push(inverse),
            None => self.push_undo(UndoStep {
                name: name.to_owned(),
                edits: vec![inverse],
            }),
        }
        Ok(())
    }

    /// Pushes a step onto the undo stack.
    fn push_undo(&mut self, step: UndoStep) {
        self.undo.push(step);
        // Remove many steps at once, since removing from the front moves all others.
        if self.undo.len() >= UNDO_STEPS + UNDO_STEPS / 4 {
            self.undo.drain(..UNDO_STEPS / 4);
        }
    }

    /// Opens a group: all edits until [`History::end`] form one step with this name. If the name is empty, the group takes
    /// the name of the first edit. A group that is still open is ended first.
    pub fn begin(&mut self, name: &str) {
        self.end();
        self.open = Some(UndoStep {
            name: name.to_owned(),
            edits: Vec::new(),
        });
    }

    /// Returns true if a group is open.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Ends the open group. A group without edits adds no step.
    pub fn end(&mut self) {
        self.redo_before_group.clear();
        if let Some(mut step) = self.open.take()
            && !step.edits.is_empty()
        {
            // Edits are undone in reverse order.
            step.edits.reverse();
            self.push_undo(step);
        }
    }

    /// Undoes the open group and discards it.
    ///
    /// # Errors
    /// The document was changed without this history; it stays as it is.
    pub fn cancel(&mut self, document: &mut Document) -> Result<(), EditError> {
        let Some(mut step) = self.open.take() else {
            return Ok(());
        };
        step.edits.reverse();
        document.apply(Edit::Batch(step.edits))?;
        if !self.redo_before_group.is_empty() {
            self.redo = std::mem::take(&mut self.redo_before_group);
        }
        Ok(())
    }

    /// Undoes the last step. Returns its name, or `None` if there is nothing to undo.
    ///
    /// # Errors
    /// The document was changed without this history; it stays as it is.
    pub fn undo(&mut self, document: &mut Document) -> Result<Option<String>, EditError> {
        self.end();
        replay(document, &mut self.undo, &mut self.redo)
    }

    /// Redoes the last undone step. Returns its name, or `None` if there is nothing to redo.
    ///
    /// # Errors
    /// The document was changed without this history; it stays as it is.
    pub fn redo(&mut self, document: &mut Document) -> Result<Option<String>, EditError> {
        self.end();
        replay(document, &mut self.redo, &mut self.undo)
    }

    /// Rewrites the paths in all steps after the document was saved in another folder. `document` is the document before
    /// its own paths were rewritten.
    pub fn relocate(&mut self, document: &Document, relocation: Relocation<'_>) {
        self.end();
        for steps in [&mut self.undo, &mut self.redo] {
            let mut state = document.clone();
            for step in steps.iter_mut().rev() {
                let edit = Edit::Batch(step.edits.clone());
                // Whether a parameter is a path follows from the kind of its node. The node exists before the step, or after it.
                let before = may_bring_paths(&edit).then(|| state.clone());
                if state.apply(edit).is_err() {
                    // The document was changed without this history. The next undo reports that.
                    break;
                }
                if let Some(before) = &before {
                    let states = vec![before, &state];
                    let paths = PathRewriter { relocation, states };
                    step.edits.iter_mut().for_each(|edit| paths.edit(edit));
                }
            }
        }
    }

    /// Names of the steps that can be undone, the next one last.
    pub fn undo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.undo.iter().chain(&self.open).map(|step| step.name.as_str())
    }

    /// Names of the steps that can be redone, the next one last.
    pub fn redo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.redo.iter().map(|step| step.name.as_str())
    }
}

/// Returns true if two edits set the same parameters or positions of nodes.
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

/// Applies the top step of one stack and pushes its inverse onto the other.
fn replay(
    document: &mut Document,
    from: &mut Vec<UndoStep>,
    to: &mut Vec<UndoStep>,
) -> Result<Option<String>, EditError> {
    let Some(step) = from.pop() else {
        return Ok(None);
    };
    match document.apply(Edit::Batch(step.edits.clone())) {
        Ok(inverse) => {
            let name = step.name;
            to.push(UndoStep {
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
