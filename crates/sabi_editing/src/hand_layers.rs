//! Layers that an artist fills or paints: a layer of one color, a layer whose mask and color are painted, and painted masks.

use sabi_graph::{Edit, NodeId, OutputRef, SlotRef, Value};

use crate::connections::PendingWire;
use crate::dropped_layers::{self, DroppedOn, LAYER};
use crate::open_document::OpenDocument;
use crate::painting::{EMPTY, PAINT};
use crate::stack::StackEnd;
use crate::{layers, nodes, wires};

/// Layer that an artist fills or paints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandLayer {
    /// A color over all of the surface.
    Fill,
    /// Strokes of a brush, which give the mask, the color and the height.
    Paint,
}

impl HandLayer {
    /// All variants with their titles.
    pub const ALL: [(HandLayer, &'static str); 2] =
        [(HandLayer::Paint, "Paint layer"), (HandLayer::Fill, "Fill layer")];

    /// Returns the title of a new layer of this type.
    pub fn title(self) -> &'static str {
        match self {
            HandLayer::Fill => "Fill layer",
            HandLayer::Paint => "Paint layer",
        }
    }
}

/// Adds a layer above all other layers of a stack, or of the only stack; if there is no output, one is added. Returns the
/// node that the artist is likely to change next: the layer, or the paint node of its mask.
pub(crate) fn add(document: &mut OpenDocument, end: Option<&StackEnd>, what: HandLayer) -> Option<NodeId> {
    let place = end.map_or(DroppedOn::Unknown, |end| DroppedOn::Output(end.clone()));
    let layer = dropped_layers::on_model(document, LAYER, None, &place, false)?;
    let label = Edit::SetLabel {
        body: document.body(),
        node: layer.clone(),
        label: Some(what.title().to_owned()),
    };
    if !document.edit("Rename", vec![label]) {
        return None;
    }
    match what {
        HandLayer::Fill => Some(layer),
        HandLayer::Paint => {
            let paint = paint_mask(document, &layer, 0.0)?;
            // The height map holds lengths already, which a height of 1 leaves as they are.
            let is_kept = nodes::set_knob(document, &layer, "height", Some(Value::Number(1.0)));
            let is_wired = [("color", "color_map"), ("height", "height_map")]
                .iter()
                .all(|(output, input)| {
                    let from = OutputRef {
                        node: paint.clone(),
                        port: Some((*output).to_owned()),
                    };
                    let map = SlotRef {
                        node: layer.clone(),
                        name: (*input).to_owned(),
                    };
                    wires::connect(document, &from, &map)
                });
            (is_kept && is_wired).then_some(paint)
        }
    }
}

/// Adds a paint node as the mask of a layer, replacing an existing mask. `empty` is the mask where nothing is painted.
pub(crate) fn paint_mask(document: &mut OpenDocument, layer: &NodeId, empty: f64) -> Option<NodeId> {
    let slot = layers::expect_mask_input(document, layer)?;
    let place = layers::place_of_mask(document, layer);
    let paint = nodes::add(document, PAINT, place, Some(&PendingWire::Into(slot)))?;
    if empty != 0.0 {
        nodes::set_knob(document, &paint, EMPTY, Some(Value::Number(empty)));
    }
    document.select([paint.clone()]);
    Some(paint)
}
