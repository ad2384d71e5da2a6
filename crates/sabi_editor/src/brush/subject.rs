//! The node that the brush paints on.

use std::sync::Arc;

use sabi_editing::painting::{strokes_of, strokes_on};
use sabi_engine::paint::Stroke;
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
    /// The decal that is marked in the list of strokes, if it is a single one.
    pub(crate) decal: Option<MarkedDecal>,
    /// The stroke that is marked in the list, if it is a single one and has a path.
    pub(crate) path: Option<Arc<Stroke>>,
}

/// A decal with handles.
pub(crate) struct MarkedDecal {
    pub(crate) stroke: Arc<Stroke>,
    /// Half of its width and height, in radii.
    pub(crate) half_sides: [f32; 2],
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
            decal: marked_decal(context, node),
            path: marked_stroke(context, node).filter(|stroke| stroke.path.is_some()),
            brush: context.settings.brush.clone(),
        })
    }
}

/// The stroke of a paint node on the shown model that is marked in the list, if it is a single one that is not hidden.
fn marked_stroke(context: &ViewContext<'_>, node: &NodeId) -> Option<Arc<Stroke>> {
    let mut marked = context.looks.marked_strokes.iter();
    let (Some(id), None) = (marked.next(), marked.next()) else {
        return None;
    };
    let model = context.evaluation.model.received.as_ref()?;
    let list = strokes_on(context.document, node, &model.linked.model.stem)?;
    let stroke = list.strokes.iter().find(|stroke| stroke.id == *id)?;
    (!stroke.is_hidden).then(|| stroke.clone())
}

/// The marked decal of a paint node on the shown model.
fn marked_decal(context: &ViewContext<'_>, node: &NodeId) -> Option<MarkedDecal> {
    let stroke = marked_stroke(context, node).filter(|stroke| stroke.area.is_single())?;
    let strokes = &context.document.session.graph().strokes;
    let picture = stroke
        .brush
        .picture
        .as_ref()
        .and_then(|tip| strokes.picture(&tip.picture));
    Some(MarkedDecal {
        stroke,
        half_sides: picture.map_or([1.0; 2], |picture| picture.half_sides().as_vec2().to_array()),
    })
}
