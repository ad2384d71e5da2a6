//! Lines and stamps along the way of a stroke.

use std::ops::Range;

use glam::{DMat2, DVec2, DVec3};
use sabi_surface::patch::{Site, axes};

use super::brush_shape::{BrushShape, ShapeSample, grain_at, random};
use super::painter::{Painter, direction};
use super::patches::PatchRequest;
use super::remaining_paint::left_of;
use super::strengths::{AddedPaint, Strengths};
use super::texels::{At, SurfaceTexels, for_texels};
use super::used_brush::UsedBrush;
use crate::brush::{Brush, TipDirection};
use crate::pen::PenPose;
use crate::site::LocatedStroke;
use crate::stroke::Area;
use crate::surface::{decal_axes, rightward};
use crate::way::{WayPoint, spaced};

/// Sine of the slope from which on a surface has a downward direction, about 2°.
const LEAST_SLOPE: f64 = 0.035;
/// Sine of the angle from which on a leaning pen has a direction, about 2°.
const LEAST_LEAN: f64 = 0.035;

/// Way in which a shape is added to the strength of a stroke.
#[derive(Clone, Copy)]
struct StampBlend {
    /// Share of its strength that a stamp adds.
    flow: f64,
    /// True if overlapping stamps add up until they cover fully; otherwise the strength is that of the strongest stamp.
    builds_up: bool,
    /// Direction of the stroke.
    direction: DVec3,
    /// Linear color of the stamp, if it differs from the brush's color.
    color: Option<[f32; 3]>,
    /// Normal of the surface under the middle of the stamp.
    normal: DVec3,
    /// Ends of the line in space; for a stamp, its middle twice.
    ends: [DVec3; 2],
}

impl StampBlend {
    /// Returns the distance in space of a place of another piece from the line; 0 on the same piece.
    fn apart(&self, is_other: bool, place: DVec3) -> f64 {
        if is_other {
            distance_to_line(place, self.ends)
        } else {
            0.0
        }
    }
}

/// Returns the distance of a point from a line segment in space.
pub(super) fn distance_to_line(place: DVec3, [from, to]: [DVec3; 2]) -> f64 {
    let way = to - from;
    let share = (place - from).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
    place.distance(from + share.clamp(0.0, 1.0) * way)
}

impl Painter<'_> {
    /// Draws the parts of a way from some points on as one line without visible stamps: the strength of a texel is that of
    /// the nearest place of the way.
    pub(super) fn draw_line(&mut self, way: &[WayPoint], parts: Range<usize>, used: &UsedBrush) {
        let brush = &used.brush;
        for (index, point) in way.iter().enumerate().take(parts.end).skip(parts.start) {
            if self.surface.is_stopped() {
                return;
            }
            let next = way.get(index + 1).filter(|next| next.is_joined);
            if next.is_none() && point.is_joined {
                continue;
            }
            let to = next.unwrap_or(point);
            let radii = [point, to].map(|point| brush.radius_at(&point.pose));
            let direction = direction(point, to);
            let plane = self.patches.lay(PatchRequest {
                from: point.site,
                to: next.map(|next| next.site),
                ahead: direction,
                radius: radii[0].max(radii[1]),
                reaches_pieces: brush.reaches_pieces,
            });
            let shape = BrushShape::Capsule {
                end: plane.end,
                radii,
                strengths: [point, to].map(|point| brush.strength_at(&point.pose)),
                hardnesses: [point, to].map(|point| brush.hardness_at(&point.pose)),
            };
            let caps = caps_of(way, index, brush).map(|share| share * radii[0] + 2.0 * (plane.reach - radii[0]));
            let within = [
                plane.end.min(DVec2::ZERO) - DVec2::new(caps[0].min(plane.reach), plane.reach),
                plane.end.max(DVec2::ZERO) + DVec2::new(caps[1].min(plane.reach), plane.reach),
            ];
            let laying = StampBlend {
                flow: 1.0,
                builds_up: false,
                direction,
                color: None,
                normal: self.normal_under(point.site),
                ends: [point, to].map(|point| point.site.position),
            };
            self.stamp(&shape, within, used, laying);
        }
    }

    /// Draws a range of the stamps of a stroke, whose strengths add up.
    pub(super) fn draw_stamps(&mut self, stamps: &[StampPlace], range: Range<usize>, used: &UsedBrush) {
        let brush = &used.brush;
        let seed = stroke_seed(stamps.first().map(|first| first.point).as_slice());
        for (index, stamp) in stamps.iter().enumerate().take(range.end).skip(range.start) {
            if self.surface.is_stopped() {
                return;
            }
            let number = |salt: i32| random(seed, [index as i32, salt, 5]);
            let jitter = brush.jitter;
            let radius = brush.radius_at(&stamp.point.pose) * (1.0 - f64::from(jitter.size) * number(1));
            let away = brush.scatter_at(&stamp.point.pose) * radius * number(2).sqrt();
            let around = std::f64::consts::TAU * number(3);
            let turn = f64::from(jitter.angle_degrees) * (2.0 * number(4) - 1.0) + turned(used, &stamp.point.pose);
            let middle = away * DVec2::new(around.cos(), around.sin());
            let ahead = self.ahead(stamp, brush.turn);
            let plane = self.patches.lay(PatchRequest {
                from: stamp.point.site,
                to: None,
                ahead,
                radius: used.reach() * radius + away,
                reaches_pieces: brush.reaches_pieces,
            });
            let shape = BrushShape::Stamp {
                middle,
                radius,
                strength: brush.strength_at(&stamp.point.pose) * (1.0 - f64::from(jitter.flow) * number(5)),
                hardness: brush.hardness_at(&stamp.point.pose),
                tip_from_plane: DMat2::from_angle(-turn.to_radians()),
                stamp: brush.tip.stamp([seed, index as u32]),
            };
            let reach = DVec2::splat(plane.reach);
            let laying = StampBlend {
                flow: f64::from(brush.flow),
                builds_up: used.builds_up(),
                direction: stamp.direction,
                color: jitter
                    .changes_color()
                    .then(|| jitter.color(brush.color, [6, 7, 8].map(|salt| 2.0 * number(salt) - 1.0))),
                normal: self.normal_under(stamp.point.site),
                ends: [self.in_space(stamp.point.site, ahead, middle); 2],
            };
            self.stamp(&shape, [-reach, reach], used, laying);
        }
    }

    /// Draws a single stamp at the first of some points, upright on the model except for the angle of the brush.
    pub(super) fn draw_single(&mut self, stroke: &LocatedStroke, area: Area, used: &UsedBrush) {
        let Some(point) = stroke.points.first() else { return };
        let normal = self.normal_under(point.site);
        let of_plane = decal_axes(point, normal, None);
        let of_decal = decal_axes(point, normal, stroke.eye);
        let decal_from_plane = DMat2::from_cols_array_2d(&of_plane.map(|axis| of_decal.map(|other| axis.dot(other))));
        let turn = DMat2::from_angle(-mirrored(used, f64::from(used.brush.angle_degrees)).to_radians());
        let radius = f64::from(used.brush.radius);
        let wanted = PatchRequest {
            from: point.site,
            to: None,
            ahead: rightward(normal),
            radius: used.reach() * radius,
            reaches_pieces: used.brush.reaches_pieces && area == Area::Decal,
        };
        let plane = match area {
            Area::Decal => self.patches.project(wanted, normal),
            _ => {
                let plane = self.patches.lay(wanted);
                self.patches.drop_misplaced(point.site);
                plane
            }
        };
        let shape = BrushShape::Stamp {
            middle: DVec2::ZERO,
            radius,
            strength: 1.0,
            hardness: f64::from(used.brush.hardness),
            tip_from_plane: turn * decal_from_plane,
            stamp: used
                .brush
                .tip
                .stamp([stroke_seed(&self.way_of(&stroke.points[..1], &used.brush)), 0]),
        };
        let reach = DVec2::splat(plane.reach);
        let laying = StampBlend {
            flow: 1.0,
            builds_up: used.builds_up(),
            direction: rightward(normal),
            color: None,
            normal,
            ends: [point.site.position; 2],
        };
        self.stamp(&shape, [-reach, reach], used, laying);
    }

    /// Calls `visit` for the texels under a stamp without random differences, on the patch that was laid last, with their
    /// positions in its plane and the strength there.
    pub(super) fn for_stamped(
        &mut self,
        stamp: &StampPlace,
        radius: f64,
        used: &UsedBrush,
        mut visit: impl FnMut(usize, DVec2, f64),
    ) {
        let shape = BrushShape::Stamp {
            middle: DVec2::ZERO,
            radius,
            strength: used.brush.strength_at(&stamp.point.pose),
            hardness: used.brush.hardness_at(&stamp.point.pose),
            tip_from_plane: DMat2::from_angle(-turned(used, &stamp.point.pose).to_radians()),
            stamp: used.brush.tip.stamp([0; 2]),
        };
        let laying = StampBlend {
            flow: f64::from(used.brush.flow) * f64::from(used.brush.opacity),
            builds_up: true,
            direction: stamp.direction,
            color: None,
            normal: self.normal_under(stamp.point.site),
            ends: [stamp.point.site.position; 2],
        };
        let reach = DVec2::splat(used.reach() * radius);
        self.for_drawn(&shape, [-reach, reach], used, laying, |_, texel, plane, added| {
            visit(texel, plane, added.flow * added.strength);
        });
    }

    /// Adds a shape to the strength of the stroke.
    fn stamp(&mut self, shape: &BrushShape, within: [DVec2; 2], used: &UsedBrush, laying: StampBlend) {
        self.for_drawn(shape, within, used, laying, |strengths, texel, _, added| {
            strengths.add(texel, added);
        });
    }

    /// Calls `visit` for all texels, on the patch that was laid last, to which a shape adds strength, with their positions in its plane.
    fn for_drawn(
        &mut self,
        shape: &BrushShape,
        within: [DVec2; 2],
        used: &UsedBrush,
        laying: StampBlend,
        mut visit: impl FnMut(&mut Strengths, usize, DVec2, &AddedPaint),
    ) {
        let Painter {
            surface,
            atlas,
            ghosts,
            patches,
            strengths,
            sight,
            ..
        } = self;
        let direction = used.kept.directions.then(|| laying.direction.as_vec3().to_array());
        let count = strengths.texel_count();
        let most = shape.most() as f32;
        let texels = SurfaceTexels { surface, atlas, ghosts };
        for laid in &patches.laid {
            let normal = surface.connected().normal(laid.placed.triangle);
            for_texels(texels, &laid.placed, within, |texel, at| {
                // Places in the middle of a line are covered by many of its parts, so those with the full strength are skipped.
                if !laying.builds_up && strengths.at(texel) >= most {
                    return;
                }
                let place = ShapeSample {
                    grain: grain_of(strengths, texel, at, used),
                    plane: at.plane,
                    rise: laid.rise,
                    apart: laying.apart(laid.is_other, at.position),
                    position: at.position,
                    normal,
                    texel: at.width,
                };
                let drawn = shape.drawn(&place, used);
                if drawn.strength <= 0.0 {
                    return;
                }
                let left = left_of(surface, sight, texel, count, at, used, laying.normal);
                let color = left.color.or(drawn.color).or(laying.color);
                let added = AddedPaint {
                    strength: drawn.strength * left.share,
                    flow: laying.flow,
                    builds_up: laying.builds_up,
                    direction,
                    color: color.filter(|_| used.kept.colors),
                };
                visit(strengths, texel, at.plane, &added);
            });
        }
    }

    /// Returns the position in space of a point in the plane around a site.
    fn in_space(&self, site: Site, ahead: DVec3, place: DVec2) -> DVec3 {
        let (x, y) = axes(self.surface.connected().normal(site.triangle), ahead);
        site.position + place.x * x + place.y * y
    }

    /// Returns the direction of the x axis of a stamp. For a single stamp, which has no direction, it is to the right as
    /// seen from outside.
    pub(super) fn ahead(&self, stamp: &StampPlace, turn: TipDirection) -> DVec3 {
        let normal = self.surface.connected().normal(stamp.point.site.triangle);
        let is_level = 1.0 - normal.y * normal.y < LEAST_SLOPE * LEAST_SLOPE;
        let toward = stamp.point.pose.lean.map_or(DVec3::ZERO, |lean| lean.toward.as_dvec3());
        match turn {
            TipDirection::Down if !is_level => DVec3::NEG_Y,
            TipDirection::Pen if toward.length_squared() > LEAST_LEAN * LEAST_LEAN => toward,
            _ if stamp.direction == DVec3::ZERO => rightward(normal),
            TipDirection::Down | TipDirection::Stroke | TipDirection::Pen => stamp.direction,
        }
    }

    /// Returns the unit shading normal at a site, or the normal of the triangle if there is no shading normal.
    pub(super) fn normal_under(&self, site: Site) -> DVec3 {
        self.surface.smooth_normal_at(site)
    }
}

/// Returns the grain of the model at a texel for the tip of a brush; 0 for a tip without grain.
fn grain_of(strengths: &mut Strengths, texel: usize, at: &At, used: &UsedBrush) -> f64 {
    if used.picture.is_some() || used.brush.tip.grain().is_none() {
        return 0.0;
    }
    strengths.grain(texel, || grain_at(&used.brush, at.position, at.width))
}

/// A stamp of a way.
pub(super) struct StampPlace {
    pub(super) point: WayPoint,
    /// Direction of the stroke.
    pub(super) direction: DVec3,
}

/// Returns how far the part of a line after a point paints before its start and behind its end, in radii. Where the line
/// continues, the adjacent part paints there, except on the outer side of a bend, which is nearest to the bend itself.
fn caps_of(way: &[WayPoint], index: usize, brush: &Brush) -> [f64; 2] {
    let next = |index: usize| way.get(index + 1).filter(|next| next.is_joined);
    let Some(to) = next(index) else { return [2.0; 2] };
    let own = direction(&way[index], to);
    let bend = |from: &WayPoint, to: &WayPoint| {
        let cosine = direction(from, to).dot(own).clamp(0.0, 1.0);
        (1.0 - cosine * cosine).sqrt()
    };
    // If the size of the brush changes, a part reaches beyond the adjacent part.
    let is_even = |others: [&WayPoint; 2]| {
        let pose = &way[index].pose;
        let presses_alike = |other: &PenPose| !brush.pressure.change_lines() || other.pressure == pose.pressure;
        let leans_alike = |other: &PenPose| !brush.tilt.change_lines() || other.lean == pose.lean;
        others
            .iter()
            .all(|other| presses_alike(&other.pose) && leans_alike(&other.pose))
    };
    let before = index
        .checked_sub(1)
        .filter(|_| way[index].is_joined)
        .map(|before| &way[before]);
    let behind = next(index + 1);
    [
        before
            .filter(|before| is_even([before, to]))
            .map_or(2.0, |before| bend(before, &way[index])),
        behind
            .filter(|behind| is_even([behind, to]))
            .map_or(2.0, |behind| bend(to, behind)),
    ]
}

/// Returns the stamps along a way.
pub(super) fn stamps_of(way: &[WayPoint], used: &UsedBrush) -> Vec<StampPlace> {
    let spacing = f64::from(used.brush.spacing);
    let stamps = spaced(way, |pose| spacing * used.brush.radius_at(pose));
    let placed = stamps.iter().enumerate().map(|(index, point)| {
        let beside = stamps.get(index + 1).filter(|next| next.is_joined);
        let (from, to) = match beside {
            Some(next) => (point, next),
            None if point.is_joined => (&stamps[index - 1], point),
            None => (point, point),
        };
        StampPlace {
            point: *point,
            direction: direction(from, to),
        }
    });
    placed.collect()
}

/// Returns the rotation of the tip for a pose of the pen in degrees, reversed in a mirror.
fn turned(used: &UsedBrush, pose: &PenPose) -> f64 {
    mirrored(used, used.brush.turn_at(pose))
}

/// Returns an angle, reversed in a mirror.
fn mirrored(used: &UsedBrush, turn: f64) -> f64 {
    if used.is_mirrored { -turn } else { turn }
}

/// Returns the seed of a stroke for random differences. It is computed from the first point, so that it is the same while
/// the stroke is drawn and whenever it is painted again.
pub(super) fn stroke_seed(way: &[WayPoint]) -> u32 {
    way.first().map_or(0, |first| {
        let [x, y, z] = first.site.position.as_vec3().to_array().map(f32::to_bits);
        x ^ y.rotate_left(11) ^ z.rotate_left(22)
    })
}
