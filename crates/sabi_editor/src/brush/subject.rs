//! The node that the brush paints on.

use std::sync::Arc;

use sabi_editing::OpenDocument;
use sabi_editing::painting::{painted_layer, strokes_of, strokes_on};
use sabi_engine::live::LiveModel;
use sabi_graph::NodeId;
use sabi_paint::{Stencil, Stroke};

use super::PaintView;
use super::stencil::ShownStencil;
use crate::context::ViewContext;
use crate::pen::PenPlace;
use crate::settings::brush::BrushChoices;

/// The node that is painted on, and the brush.
pub(crate) struct PaintSubject {
    /// Paint node in the shown graph.
    pub(super) node: NodeId,
    /// Versions of its strokes.
    pub(super) strokes: String,
    /// Name of the layer, mask or node that strokes change, for captions.
    pub(crate) title: String,
    pub(crate) brush: BrushChoices,
    /// The picture over the view that strokes are painted through.
    pub(crate) stencil: Option<ShownStencil>,
    /// The decal that is marked in the list of strokes, if it is a single one.
    pub(crate) decal: Option<MarkedDecal>,
    /// The stroke that is marked in the list, if it is a single one and has a path.
    pub(crate) path: Option<Arc<Stroke>>,
    /// Places of the pointer in this frame that a pen reported, in order.
    pub(super) pen: Vec<PenPlace>,
    /// All strokes that are marked in the list, the lowest first.
    pub(crate) marked: Vec<Arc<Stroke>>,
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
        let marked = marked_strokes(context, node);
        Some(PaintSubject {
            strokes: strokes_of(document, node)?,
            title: title_of(document, node),
            node: node.clone(),
            decal: marked_decal(context, &marked),
            path: only(&marked).filter(|stroke| stroke.path.is_some()),
            marked,
            brush: context.settings.brush.clone(),
            pen: context.pens.places.clone(),
            stencil: shown_stencil(context),
        })
    }

    /// The stencil as a stroke keeps it, projected onto a model; `None` in a view of its texture.
    pub(super) fn stencil_before(&self, model: &LiveModel, canvas: &impl PaintView) -> Option<Arc<Stencil>> {
        let shown = self.stencil.as_ref()?;
        let stencil = Stencil {
            picture: shown.choices.picture.clone()?,
            picture_from_model: canvas.stencil_map(model, shown)?,
        };
        Some(Arc::new(stencil))
    }
}

/// Returns the name of the layer, mask or node that strokes of a paint node change.
fn title_of(document: &OpenDocument, node: &NodeId) -> String {
    match painted_layer(document, node) {
        Some(layer) if layer.is_mask_alone => format!("the mask of {}", layer.title),
        Some(layer) => layer.title,
        None => document.title(node),
    }
}

/// The strokes of a paint node on the shown model that are marked in the list, without hidden ones.
fn marked_strokes(context: &ViewContext<'_>, node: &NodeId) -> Vec<Arc<Stroke>> {
    let marked = &context.looks.marked_strokes;
    let model = context
        .evaluation
        .model
        .received
        .as_ref()
        .filter(|_| !marked.is_empty());
    let list = model.and_then(|model| strokes_on(context.document, node, &model.linked.model.stem));
    let strokes = list.iter().flat_map(|list| &list.strokes);
    let shown = strokes.filter(|stroke| marked.contains(&stroke.id) && !stroke.leaves_nothing());
    shown.cloned().collect()
}

/// The marked stroke, if it is a single one.
fn only(marked: &[Arc<Stroke>]) -> Option<Arc<Stroke>> {
    match marked {
        [only] => Some(only.clone()),
        _ => None,
    }
}

/// The stencil, while it is used and its picture is in memory.
fn shown_stencil(context: &ViewContext<'_>) -> Option<ShownStencil> {
    let choices = &context.settings.stencil;
    let tip = choices.picture.as_ref().filter(|_| choices.is_used)?;
    let strokes = &context.document.session.graph().strokes;
    Some(ShownStencil {
        picture: strokes.picture(&tip.picture)?,
        choices: choices.clone(),
    })
}

/// The marked decal of a paint node on the shown model.
fn marked_decal(context: &ViewContext<'_>, marked: &[Arc<Stroke>]) -> Option<MarkedDecal> {
    let stroke = only(marked).filter(|stroke| stroke.area.is_single())?;
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
