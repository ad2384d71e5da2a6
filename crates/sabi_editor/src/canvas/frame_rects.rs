//! Rectangles of frames.

use egui::{Pos2, Rect, vec2};
use sabi_editing::OpenDocument;
use sabi_editing::frames::{FRAME_AROUND, FRAME_STRIP};

use super::camera::CanvasCamera;
use super::node_rect;

/// Rectangle of a frame on the canvas; `None` where none of its nodes exists.
pub(super) fn rect_of(document: &OpenDocument, id: &str) -> Option<Rect> {
    let frame = document.graph().frames().get(id)?;
    let rects = frame.nodes.iter().filter_map(|id| node_rect(document, id));
    let all = rects.reduce(|all, rect| all.union(rect))?.expand(FRAME_AROUND);
    Some(Rect::from_min_max(all.min - vec2(0.0, FRAME_STRIP), all.max))
}

/// Frame at a place of the screen that the selected nodes can be dropped into: one that contains none of them yet.
pub(super) fn under(camera: &CanvasCamera, document: &OpenDocument, pointer: Pos2) -> Option<String> {
    let panel = camera.panel?;
    let frames = document.graph().frames().iter();
    let others = frames.filter(|(_, frame)| !frame.nodes.iter().any(|id| document.selection().contains(id)));
    let mut under = others.filter(|(id, _)| {
        let rect = rect_of(document, id).map(|rect| camera.view.screen_rect(panel, rect));
        rect.is_some_and(|rect| rect.contains(pointer))
    });
    under.next().map(|(id, _)| id.clone())
}
