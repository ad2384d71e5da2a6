//! The mini map: the whole graph in a corner, where a click or a drag moves the view.

use egui::{Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, WidgetType, pos2, vec2};

use super::{Canvas, CanvasContext, node_rect};

const SIZE: [f32; 2] = [180.0, 120.0];
const FROM_CORNER: f32 = 12.0;

pub(super) fn show(canvas: &mut Canvas, ui: &Ui, panel: Rect, context: &CanvasContext<'_>) {
    let document = context.document;
    let nodes: Vec<(Rect, egui::Color32)> = document
        .graph()
        .ids()
        .filter_map(|id| {
            let category = document.interface(id).map_or("", |interface| interface.category());
            let color = if document.selection().contains(id) {
                context.theme.accent
            } else {
                context.theme.category(category)
            };
            Some((node_rect(document, id)?, color))
        })
        .collect();
    let corner = panel.max - vec2(FROM_CORNER, FROM_CORNER);
    let map = Rect::from_min_max(corner - vec2(SIZE[0], SIZE[1]), corner);
    let seen = canvas.camera.view.visible_rect(panel);
    let all = nodes.iter().fold(seen, |all, (rect, _)| all.union(*rect));
    let scale = (map.size() / all.size()).min_elem() * 0.94;
    let shown = |at: egui::Pos2| map.center() + (at - all.center()) * scale;
    let shown_rect = |rect: Rect| Rect::from_min_max(shown(rect.min), shown(rect.max));
    let painter = ui.painter().with_clip_rect(map);
    painter.rect(
        map,
        4.0,
        context.theme.panel.gamma_multiply(0.9),
        Stroke::new(1.0, context.theme.line),
        StrokeKind::Inside,
    );
    for (rect, color) in nodes {
        painter.rect_filled(shown_rect(rect), 1.0, color);
    }
    painter.rect_stroke(
        shown_rect(seen),
        1.0,
        Stroke::new(1.0, context.theme.text),
        StrokeKind::Inside,
    );
    let response = ui.interact(map, ui.id().with("mini_map"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, "Mini map"));
    if let Some(at) = response
        .interact_pointer_pos()
        .filter(|_| response.dragged() || response.clicked())
    {
        let meant = all.center() + (at - map.center()) / scale;
        let middle = panel.size() / 2.0;
        canvas.camera.view.pan = middle - pos2(meant.x, meant.y).to_vec2() * canvas.camera.view.zoom;
    }
}
