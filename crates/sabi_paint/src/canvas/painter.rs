//! Lays strokes on a canvas.

use glam::{DMat2, DVec2, DVec3};
use sabi_surface::Groups;
use sabi_surface::atlas::Atlas;

use super::Canvas;
use super::fills::{for_gradient, for_texels_of};
use super::patches::{Patches, Wanted};
use super::shape::{Place, Shape, random};
use super::texels::{for_texels, ghosts_of_triangles};
use crate::brush::{Brush, Tip};
use crate::site::{copies, relocate};
use crate::stroke::{Area, Stroke, StrokePoint};
use crate::surface::PaintSurface;
use crate::way::{WayPoint, spaced, way_of};

/// Longest part of a way, as a share of the brush's radius: a part is a straight line on the unfolded surface.
const PART: f64 = 0.5;

/// Lays strokes on canvases of one atlas.
pub struct Painter<'a> {
    surface: &'a PaintSurface<'a>,
    atlas: &'a Atlas,
    ghosts: Groups,
    patches: Patches<'a>,
    strengths: Strengths,
    /// Direction of the stroke at each texel that it touches, where directions are kept.
    direction: Vec<[f32; 3]>,
}

/// Strength of the stroke at each texel.
struct Strengths {
    /// 0 where the stroke does not touch, and everywhere between strokes.
    texels: Vec<f32>,
    /// Texels that the stroke touches, each once.
    touched: Vec<u32>,
}

impl Strengths {
    fn set(&mut self, texel: usize, strength: f32) {
        let known = &mut self.texels[texel];
        if *known == 0.0 {
            self.touched.push(texel as u32);
        }
        // Touched only once, also where the strength is too small for a float.
        *known = strength.max(f32::MIN_POSITIVE);
    }

    /// Ends the stroke: texels that it touched, with its strength there.
    fn take(&mut self) -> Vec<(u32, f32)> {
        let texels = &mut self.texels;
        let touched = self.touched.drain(..);
        touched
            .map(|texel| (texel, std::mem::take(&mut texels[texel as usize])))
            .collect()
    }
}

/// What a stroke leaves, before it lies on a canvas.
pub struct LaidStroke {
    /// Texels with the strength of the stroke there.
    texels: Vec<(u32, f32)>,
    /// Directions of the stroke there; empty where they are not kept.
    directions: Vec<[f32; 3]>,
    /// Places of the stroke that the model does not have any more.
    pub lost: usize,
}

impl LaidStroke {
    /// Lays the stroke on a canvas.
    pub fn onto(&self, canvas: &mut Canvas, stroke: &Stroke) {
        let brush = stroke.brush.bounded();
        for (index, (texel, strength)) in self.texels.iter().enumerate() {
            let direction = self.directions.get(index).copied().unwrap_or([0.0; 3]); // Not kept, and so not read.
            canvas.lay(
                *texel as usize,
                stroke.action,
                &brush,
                strength * brush.opacity,
                direction,
            );
        }
    }
}

impl<'a> Painter<'a> {
    /// Prepares for an atlas of a surface.
    pub fn new(surface: &'a PaintSurface<'a>, atlas: &'a Atlas) -> Painter<'a> {
        Painter {
            ghosts: ghosts_of_triangles(atlas),
            patches: Patches::new(surface, atlas),
            strengths: Strengths {
                texels: vec![0.0; atlas.owners.len()],
                touched: Vec::new(),
            },
            direction: Vec::new(),
            surface,
            atlas,
        }
    }

    /// Lays a stroke on a canvas, and returns how many of its places the model does not have any more.
    pub fn paint(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        let laid = self.lay(stroke, !canvas.direction.is_empty());
        laid.onto(canvas, stroke);
        laid.lost
    }

    /// What a stroke leaves, with its directions if they are kept.
    pub fn lay(&mut self, stroke: &Stroke, keeps_direction: bool) -> LaidStroke {
        let (points, lost) = relocate(self.surface, stroke);
        if !stroke.is_hidden && !points.is_empty() {
            if keeps_direction && self.direction.is_empty() {
                self.direction = vec![[0.0; 3]; self.atlas.owners.len()];
            }
            let brush = stroke.brush.bounded();
            let others = copies(self.surface, &points, brush.symmetry, f64::from(brush.radius));
            for points in std::iter::once(points).chain(others) {
                self.draw(&points, stroke.area, &brush, keeps_direction);
            }
        }
        let texels = self.strengths.take();
        let directions = texels.iter().filter(|_| keeps_direction);
        LaidStroke {
            directions: directions.map(|(texel, _)| self.direction[*texel as usize]).collect(),
            texels,
            lost,
        }
    }

    fn draw(&mut self, points: &[StrokePoint], area: Area, brush: &Brush, keeps_direction: bool) {
        let (surface, atlas, ghosts) = (self.surface, self.atlas, &self.ghosts);
        let strengths = &mut self.strengths;
        let mut fill = |texel: usize, drawn: f64| {
            if drawn > 0.0 {
                strengths.set(texel, strengths.texels[texel].max(drawn as f32));
            }
        };
        match area {
            Area::Way => {}
            Area::Gradient => return for_gradient((surface, atlas, ghosts), points, fill),
            _ => return for_texels_of(surface, atlas, points, area, |texel| fill(texel, 1.0)),
        }
        let way = way_of(self.surface, points, PART * f64::from(brush.radius));
        let is_line = brush.flow >= 1.0 && brush.tip == Tip::Round && brush.jitter == Default::default();
        if is_line {
            self.draw_line(&way, brush, keeps_direction);
        } else {
            self.draw_stamps(&way, brush, keeps_direction);
        }
    }

    /// Draws a way as one line without beads: the strength of a texel is that of the nearest place of the way.
    fn draw_line(&mut self, way: &[WayPoint], brush: &Brush, keeps_direction: bool) {
        for (index, point) in way.iter().enumerate() {
            let next = way.get(index + 1).filter(|next| next.is_joined);
            if next.is_none() && point.is_joined {
                continue;
            }
            let to = next.unwrap_or(point);
            let radii = [point, to].map(|point| brush.radius_at(point.pressure));
            let direction = direction(point, to);
            let plane = self.patches.lay(Wanted {
                from: point.site,
                to: next.map(|next| next.site),
                ahead: direction,
                radius: radii[0].max(radii[1]),
                reaches_pieces: brush.reaches_pieces,
            });
            let shape = Shape::Capsule {
                end: plane.end,
                radii,
                strengths: [point, to].map(|point| brush.strength_at(point.pressure)),
            };
            let within = [
                plane.end.min(DVec2::ZERO) - plane.reach,
                plane.end.max(DVec2::ZERO) + plane.reach,
            ];
            let kept = keeps_direction.then(|| direction.as_vec3().to_array());
            self.stamp(&shape, within, brush, kept, f64::max);
        }
    }

    /// Draws single stamps that build up.
    fn draw_stamps(&mut self, way: &[WayPoint], brush: &Brush, keeps_direction: bool) {
        let spacing = f64::from(brush.spacing);
        let stamps = spaced(way, |pressure| spacing * brush.radius_at(pressure));
        let seed = stroke_seed(way);
        for (index, point) in stamps.iter().enumerate() {
            let beside = stamps.get(index + 1).filter(|next| next.is_joined);
            let (from, to) = match beside {
                Some(next) => (point, next),
                None if point.is_joined => (&stamps[index - 1], point),
                None => (point, point),
            };
            let direction = direction(from, to);
            let number = |salt: i32| random(seed, [index as i32, salt, 5]);
            let jitter = brush.jitter;
            let radius = brush.radius_at(point.pressure) * (1.0 - f64::from(jitter.size) * number(1));
            let away = f64::from(jitter.place) * radius * number(2).sqrt();
            let around = std::f64::consts::TAU * number(3);
            let middle = away * DVec2::new(around.cos(), around.sin());
            let corner = if brush.tip == Tip::Square {
                std::f64::consts::SQRT_2
            } else {
                1.0
            };
            let plane = self.patches.lay(Wanted {
                from: point.site,
                to: None,
                ahead: direction,
                radius: corner * radius + away,
                reaches_pieces: brush.reaches_pieces,
            });
            let turn = f64::from(jitter.angle_degrees) * (2.0 * number(4) - 1.0) + f64::from(brush.angle_degrees);
            let shape = Shape::Stamp {
                middle,
                radius,
                strength: brush.strength_at(point.pressure) * (1.0 - f64::from(jitter.flow) * number(5)),
                tip_from_plane: DMat2::from_angle(-turn.to_radians()),
                seeds: [seed, index as u32],
            };
            let flow = f64::from(brush.flow);
            let kept = keeps_direction.then(|| direction.as_vec3().to_array());
            let reach = DVec2::splat(plane.reach);
            self.stamp(&shape, [-reach, reach], brush, kept, |laid, drawn| {
                laid + (1.0 - laid) * flow * drawn
            });
        }
    }

    /// Adds a shape to the strength of the stroke; `joined` gives the new strength from the one so far and the shape's.
    fn stamp(
        &mut self,
        shape: &Shape,
        within: [DVec2; 2],
        brush: &Brush,
        direction: Option<[f32; 3]>,
        joined: impl Fn(f64, f64) -> f64,
    ) {
        let (strengths, directions) = (&mut self.strengths, &mut self.direction);
        let connected = self.surface.connected();
        for laid in &self.patches.laid {
            for_texels(
                (connected, self.atlas, &self.ghosts),
                &laid.placed,
                within,
                |texel, at| {
                    let place = Place {
                        plane: at.plane,
                        rise: laid.rise,
                        position: at.position,
                        texel: at.width,
                    };
                    let drawn = shape.strength(&place, brush);
                    if drawn <= 0.0 {
                        return;
                    }
                    let before = strengths.texels[texel];
                    let after = joined(f64::from(before), drawn) as f32;
                    if let Some(direction) = direction.filter(|_| before == 0.0 || after > before) {
                        directions[texel] = direction;
                    }
                    strengths.set(texel, after);
                },
            );
        }
    }
}

/// Number of a stroke for random differences, from its first place: the same while it is drawn and whenever it is drawn again.
fn stroke_seed(way: &[WayPoint]) -> u32 {
    way.first().map_or(0, |first| {
        let [x, y, z] = first.site.position.as_vec3().to_array().map(f32::to_bits);
        x ^ y.rotate_left(11) ^ z.rotate_left(22)
    })
}

/// Unit direction in model space from one place to another; zero for one place.
fn direction(from: &WayPoint, to: &WayPoint) -> DVec3 {
    (to.site.position - from.site.position).normalize_or_zero()
}
