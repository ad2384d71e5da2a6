//! The node that the brush paints on.

use sabi_editing::painting::strokes_of;
use sabi_graph::NodeId;

use crate::context::ViewContext;
use crate::settings::brush::BrushChoices;

/// The node that is painted on, and the brush.
pub(crate) struct PaintSubject {
    /// Paint node in the shown graph.
    pub(super) node: NodeId,
    /// Versions of its strokes.
    pub(super) strokes: String,
    pub(crate) title: String,
    pub(crate) brush: BrushChoices,
}

impl PaintSubject {
    /// The selected paint node, while drags paint.
    pub(crate) fn of(context: &ViewContext<'_>) -> Option<PaintSubject> {
        let document = context.document;
        let looks = context.looks;
        // A click for a color paints nothing.
        let paints = looks.is_painting && looks.color_target.is_none();
        let node = document.selected_one().filter(|_| paints)?;
        Some(PaintSubject {
            strokes: strokes_of(document, node)?,
            title: document.title(node),
            node: node.clone(),
            brush: context.settings.brush.clone(),
        })
    }
}
