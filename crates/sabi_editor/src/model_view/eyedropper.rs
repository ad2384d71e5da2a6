//! Colors taken from the model: the exact base color under the pointer, without light.

use egui::{CursorIcon, Pos2, Rect, Response};
use sabi_view::{Background, Mode, NodeType, Shot};

use super::model_view_pictures::{Lighting, PictureRequest};
use super::painting::shot_of;
use super::{ModelView, Subject};
use crate::action::ClickedColor;
use crate::evaluation::{Evaluation, ResultPicture};

impl ModelView {
    /// Clicked color, while one is taken.
    pub(super) fn clicked_color(
        &mut self,
        response: &Response,
        rect: Rect,
        evaluation: &Evaluation,
        picture: &ResultPicture,
        subject: &Subject<'_>,
    ) -> Option<ClickedColor> {
        if !subject.is_picking_color {
            return None;
        }
        response.clone().on_hover_cursor(CursorIcon::Crosshair);
        let at = response.interact_pointer_pos().filter(|_| response.clicked())?;
        if !rect.contains(at) {
            return Some(Err("Colors are taken from the first model; click there.".to_owned()));
        }
        if evaluation.results.picture(subject.shown).is_none() {
            return Some(Err(
                "What the model shows is not evaluated yet; click again in a moment.".to_owned(),
            ));
        }
        let line = self.comparison.share.map(|share| rect.left() + share * rect.width());
        let other = subject.pinned.and_then(|seen| evaluation.results.picture(seen));
        Some(match other.filter(|_| line.is_some_and(|line| at.x >= line)) {
            Some(other) => self.color_at(1, at, rect, evaluation, &other.clone()),
            None => self.color_at(0, at, rect, evaluation, picture),
        })
    }

    /// Draws the base color alone and reads the pixel, which is right for every texture set, size and seam.
    fn color_at(
        &mut self,
        screen: usize,
        at: Pos2,
        rect: Rect,
        evaluation: &Evaluation,
        picture: &ResultPicture,
    ) -> ClickedColor {
        let node = picture.looks.looks.last().and_then(|look| look.node.as_ref());
        let what = match node.map(|node| node.value_type) {
            None | Some(NodeType::Color) => None,
            Some(NodeType::Mask) => Some("a mask"),
            Some(NodeType::Vector) => Some("a vector"),
        };
        if let Some(what) = what {
            return Err(format!(
                "The model shows {what}, which has no color; have it show the outputs or a node that gives a color."
            ));
        }
        let shot = Shot {
            mode: if picture.looks.is_lit {
                Mode::BaseColor
            } else {
                Mode::Node
            },
            background: Background::Clear,
            lines: Vec::new(),
            samples: 1,
            ..shot_of(self.navigation.camera, &self.shot, picture, Mode::Node)
        };
        let request = PictureRequest {
            picture,
            shot,
            lighting: &Lighting::of(&self.environment, &self.lights),
            is_moving: false,
        };
        let size = [rect.width(), rect.height()].map(|side| side.round().max(1.0) as u32);
        let failed = |error: &dyn std::fmt::Display| format!("The color cannot be read: {error}");
        let gpu = evaluation.gpu();
        self.pictures
            .draw(screen, gpu, &request, size)
            .map_err(|error| failed(&error))?;
        let pixels = self.pictures.pixels(screen, gpu);
        let Some(pixels) = pixels.map_err(|error| failed(&error))? else {
            return Err("The model is not drawn yet; click again in a moment.".to_owned());
        };
        let [x, y] = [at.x - rect.left(), at.y - rect.top()].map(|at| at.max(0.0) as usize);
        let [width, height] = pixels.size.map(|side| side as usize);
        let pixel = 4 * (y.min(height - 1) * width + x.min(width - 1));
        match pixels.rgba[pixel..pixel + 4] {
            [red, green, blue, alpha] if alpha > 0 => Ok([red, green, blue]),
            _ => Err("There is no surface under the pointer to take a color from.".to_owned()),
        }
    }
}
