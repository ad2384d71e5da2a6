//! Lays strokes on a canvas.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use sabi_surface::atlas::Atlas;
use sabi_surface::patch::Site;
use sabi_surface::patch::{PlacedTriangle, Unfolder};

use super::Canvas;
use super::texels::{GhostsOfTriangles, for_texels, texel_width};
use crate::brush::Brush;
use crate::site::relocate;
use crate::stroke::Stroke;
use crate::surface::PaintSurface;
use crate::way::{WayPoint, spaced, way_of};

/// Longest part of a way, as a share of the brush's radius: a part is a straight line on the unfolded surface.
const PART: f64 = 0.5;
/// Least cosine between the surface under the brush and another piece that it reaches.
const LEAST_FACING: f64 = 0.5;

/// Lays strokes on canvases of one atlas.
pub struct Painter<'a> {
    surface: &'a PaintSurface<'a>,
    atlas: &'a Atlas,
    ghosts: GhostsOfTriangles,
    unfolder: Unfolder,
    patch: Vec<PlacedTriangle>,
    /// The patch, and what lies beside it.
    laid: Vec<LaidTriangle>,
    near: Vec<u32>,
    /// Strength of the stroke at each texel; 0 between strokes.
    strength: Vec<f32>,
    /// Direction of the stroke at each texel that it touches, where a canvas keeps directions.
    direction: Vec<[f32; 3]>,
    /// Texels that the stroke touches.
    touched: Vec<usize>,
}

/// A triangle in the plane of a patch, or beside it.
#[derive(Clone, Copy)]
struct LaidTriangle {
    placed: PlacedTriangle,
    /// Its height over the plane.
    rise: f64,
}

/// A stamp of a round brush, or its way from one place to the next.
struct Capsule {
    /// Start and end in the plane of the patch.
    ends: [DVec2; 2],
    radii: [f64; 2],
    strengths: [f64; 2],
    /// Unit direction in model space.
    direction: [f32; 3],
}

impl<'a> Painter<'a> {
    /// Prepares for an atlas of a surface.
    pub fn new(surface: &'a PaintSurface<'a>, atlas: &'a Atlas) -> Painter<'a> {
        Painter {
            ghosts: GhostsOfTriangles::new(atlas),
            unfolder: Unfolder::new(surface.triangle_count()),
            patch: Vec::new(),
            laid: Vec::new(),
            near: Vec::new(),
            strength: vec![0.0; atlas.owners.len()],
            direction: Vec::new(),
            touched: Vec::new(),
            surface,
            atlas,
        }
    }

    /// Lays a stroke, and returns how many of its places the model does not have any more.
    pub fn paint(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        let (points, lost) = relocate(self.surface, stroke);
        if stroke.is_hidden || points.is_empty() {
            return lost;
        }
        let brush = stroke.brush.bounded();
        let keeps_direction = !canvas.direction.is_empty();
        if keeps_direction && self.direction.is_empty() {
            self.direction = vec![[0.0; 3]; self.atlas.owners.len()];
        }
        let way = way_of(self.surface, &points, PART * f64::from(brush.radius));
        if brush.flow >= 1.0 {
            self.draw_line(&way, &brush, keeps_direction);
        } else {
            self.draw_stamps(&way, &brush, keeps_direction);
        }
        for texel in self.touched.drain(..) {
            let strength = std::mem::take(&mut self.strength[texel]);
            let direction = if keeps_direction {
                self.direction[texel]
            } else {
                [0.0; 3]
            };
            canvas.lay(texel, stroke.action, &brush, strength * brush.opacity, direction);
        }
        lost
    }

    /// Draws a way as one line without beads: the strength of a texel is that of the nearest place of the way.
    fn draw_line(&mut self, way: &[WayPoint], brush: &Brush, keeps_direction: bool) {
        for (index, point) in way.iter().enumerate() {
            let next = way.get(index + 1).filter(|next| next.is_joined);
            if next.is_none() && point.is_joined {
                continue;
            }
            let (capsule, low, high) = self.capsule(point, next, brush);
            self.stamp(&capsule, [low, high], brush, keeps_direction, f64::max);
        }
    }

    /// Draws single stamps that build up.
    fn draw_stamps(&mut self, way: &[WayPoint], brush: &Brush, keeps_direction: bool) {
        let spacing = f64::from(brush.spacing);
        let stamps = spaced(way, |pressure| spacing * brush.radius_at(pressure));
        let flow = f64::from(brush.flow);
        for (index, point) in stamps.iter().enumerate() {
            let (mut capsule, low, high) = self.capsule(point, None, brush);
            let beside = stamps.get(index + 1).filter(|next| next.is_joined);
            let (from, to) = match beside {
                Some(next) => (point, next),
                None if point.is_joined => (&stamps[index - 1], point),
                None => (point, point),
            };
            capsule.direction = direction(from, to);
            self.stamp(&capsule, [low, high], brush, keeps_direction, |laid, drawn| {
                laid + (1.0 - laid) * flow * drawn
            });
        }
    }

    /// Unfolds the surface around a way from one place to the next, or around a single place; returns the capsule in its plane,
    /// and the box of the plane that the capsule fills.
    fn capsule(&mut self, from: &WayPoint, to: Option<&WayPoint>, brush: &Brush) -> (Capsule, DVec2, DVec2) {
        let chord = to.map_or(0.0, |to| from.site.position.distance(to.site.position));
        let radii = [from, to.unwrap_or(from)].map(|point| brush.radius_at(point.pressure));
        let strengths = [from, to.unwrap_or(from)].map(|point| brush.strength_at(point.pressure));
        let radius = radii[0].max(radii[1]);
        let ahead = to.map_or(DVec3::X, |to| to.site.position - from.site.position);
        let connected = self.surface.connected();
        self.unfolder.unfold(connected, from.site, ahead, 0.0, &mut self.patch);
        let first = self.patch.first();
        // Half a texel more than the radius, for the border of a hard brush.
        let texel = first.map_or(0.0, |first| texel_width(self.surface.mesh(), self.atlas, first));
        let radius = 1.01 * radius + 0.5 * texel;
        self.unfolder
            .unfold(connected, from.site, ahead, radius + 1.5 * chord, &mut self.patch);
        let end = to.and_then(|to| {
            let placed = self.patch.iter().find(|placed| placed.triangle == to.site.triangle)?;
            placed.place_of(connected.corners(to.site.triangle), to.site.position)
        });
        self.laid.clear();
        self.laid.extend(self.patch.iter().map(|placed| unfolded(*placed)));
        if brush.reaches_pieces {
            self.lay_other_pieces(from.site, ahead, radius + chord);
        }
        let ends = [DVec2::ZERO, end.unwrap_or(DVec2::ZERO)];
        let capsule = Capsule {
            ends,
            radii,
            strengths,
            direction: direction(from, to.unwrap_or(from)),
        };
        let low = ends[0].min(ends[1]) - radius;
        let high = ends[0].max(ends[1]) + radius;
        (capsule, low, high)
    }

    /// Lays other pieces near a site into the plane, so that a stroke goes on over the joint of two boards: each from its nearest
    /// place on, turned to lie flat, as high over the plane as that place. Pieces that face away there, such as the other side of
    /// a wall, stay clean.
    fn lay_other_pieces(&mut self, site: Site, ahead: DVec3, reach: f64) {
        let index = self.surface.index();
        if index.piece_count < 2 {
            return;
        }
        let connected = self.surface.connected();
        let normal = connected.normal(site.triangle);
        let (x, y) = axes(normal, ahead);
        index.near(site.position - reach, site.position + reach, &mut self.near);
        let mut nearest: BTreeMap<u32, (f64, u32, DVec3)> = BTreeMap::new();
        for &triangle in &self.near {
            let piece = index.pieces[triangle as usize];
            if piece == index.pieces[site.triangle as usize] || connected.normal(triangle).dot(normal) < LEAST_FACING {
                continue;
            }
            let place = connected.nearest_in(triangle, site.position);
            let distance = place.distance(site.position);
            let is_nearer = nearest.get(&piece).is_none_or(|(least, ..)| distance < *least);
            if distance < reach && is_nearer {
                nearest.insert(piece, (distance, triangle, place));
            }
        }
        for (_, triangle, place) in nearest.into_values() {
            let offset = place - site.position;
            let middle = DVec2::new(offset.dot(x), offset.dot(y));
            let (own_x, own_y) = axes(connected.normal(triangle), x);
            let corners = connected.corners(triangle).map(|corner| {
                let own = corner - place;
                middle + DVec2::new(own.dot(own_x), own.dot(own_y))
            });
            self.patch.clear();
            let from = PlacedTriangle { triangle, corners };
            self.unfolder.grow(connected, from, reach, &mut self.patch);
            let rise = offset.dot(normal);
            self.laid
                .extend(self.patch.iter().map(|placed| LaidTriangle { placed: *placed, rise }));
        }
    }

    /// Adds a capsule to the strength of the stroke; `joined` gives the new strength from the one so far and the capsule's.
    fn stamp(
        &mut self,
        capsule: &Capsule,
        within: [DVec2; 2],
        brush: &Brush,
        keeps_direction: bool,
        joined: impl Fn(f64, f64) -> f64,
    ) {
        let (strengths, touched, directions) = (&mut self.strength, &mut self.touched, &mut self.direction);
        for laid in &self.laid {
            for_texels(
                (self.surface.mesh(), self.atlas, &self.ghosts),
                &laid.placed,
                within,
                |texel, place, width| {
                    let drawn = capsule.strength(place, laid.rise, width, brush);
                    if drawn <= 0.0 {
                        return;
                    }
                    let before = strengths[texel];
                    let after = joined(f64::from(before), drawn) as f32;
                    if before == 0.0 {
                        touched.push(texel);
                    }
                    if keeps_direction && (before == 0.0 || after > before) {
                        directions[texel] = capsule.direction;
                    }
                    // Touched only once, also where the strength is too small for a float.
                    strengths[texel] = after.max(f32::MIN_POSITIVE);
                },
            );
        }
    }
}

/// Axes of the plane along a surface: x ahead, and y to its left as seen from outside.
fn axes(normal: DVec3, ahead: DVec3) -> (DVec3, DVec3) {
    let flat = ahead - normal * normal.dot(ahead);
    let x = flat.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    (x, normal.cross(x))
}

/// A triangle that the surface was unfolded to.
fn unfolded(placed: PlacedTriangle) -> LaidTriangle {
    LaidTriangle { placed, rise: 0.0 }
}

/// Unit direction in model space from one place to another; zero for one place.
fn direction(from: &WayPoint, to: &WayPoint) -> [f32; 3] {
    (to.site.position - from.site.position)
        .normalize_or_zero()
        .as_vec3()
        .to_array()
}

impl Capsule {
    /// Strength at a place in the plane, 0 to 1; `width` is that of texels, model units. A border that is harder than texels
    /// can show becomes one texel wide, and a brush that is thinner than a texel becomes faint.
    fn strength(&self, place: DVec2, rise: f64, width: f64, brush: &Brush) -> f64 {
        let along = self.ends[1] - self.ends[0];
        let square = along.length_squared();
        let t = if square > 0.0 {
            ((place - self.ends[0]).dot(along) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mix = |[start, end]: [f64; 2]| start + t * (end - start);
        let radius = mix(self.radii);
        let distance = place.distance(self.ends[0] + t * along).hypot(rise);
        let band = (1.0 - f64::from(brush.hardness)) * radius;
        let fall = if band >= width {
            brush.falloff(distance / radius)
        } else {
            ((radius - 0.5 * band - distance) / width + 0.5).clamp(0.0, 1.0)
        };
        fall * mix(self.strengths) * (2.0 * radius / width).min(1.0)
    }
}
