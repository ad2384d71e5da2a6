//! Ribbons: stamps in a row along a way, bent with it.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::brush_shape::{LEAST_TEXEL, faded, grain_at};
use super::painter::{Painter, direction};
use super::patches::{LaidTriangle, PatchRequest};
use super::remaining_paint::left_of;
use super::stamps::{distance_to_line, stroke_seed};
use super::strengths::AddedPaint;
use super::texels::{At, for_texels};
use super::used_brush::UsedBrush;
use crate::pen::PenPose;
use crate::picture::{PictureEnds, StampSample};
use crate::surface::PaintSurface;
use crate::tips::{Spot, Stamp};
use crate::way::WayPoint;

/// A part of a way without gaps, as used by the ribbon along it.
struct WayRun<'a> {
    points: &'a [WayPoint],
    /// Length of the way up to each point in model units.
    passed: Vec<f64>,
    /// Length of a stamp along the way in model units. The run has a whole number of stamps.
    stamp: f64,
    /// True if the run returns to its start.
    is_closed: bool,
    /// Seed of the stroke for random differences.
    seed: u32,
}

/// A texel next to a part of the way.
struct RibbonTexel {
    texel: u32,
    part: u32,
    /// Distance from the way in model units. For this distance, the way is extended beyond its ends.
    distance: f64,
    /// Distance from the way itself.
    rank: f64,
    /// Length of the way up to its place nearest to the texel, in model units.
    along: f64,
    /// Distance to the left of the way in model units; negative to the right.
    across: f64,
    /// Triangle, and the weights of its second and third corner.
    triangle: u32,
    weights: [f32; 2],
    /// Width of the texel in model units.
    width: f64,
}

/// Number of texels that are found before those that are nearer to another part are removed. This limits the memory of wide ribbons.
const FOUND_LIMIT: usize = 1 << 22;

/// Keeps only the entry with the part of the way that is nearest to each texel; of equally near parts, the first.
fn keep_nearest(all: &mut Vec<RibbonTexel>) {
    all.sort_unstable_by(|a, b| {
        let by_distance = a.rank.total_cmp(&b.rank);
        a.texel.cmp(&b.texel).then(by_distance).then(a.part.cmp(&b.part))
    });
    all.dedup_by_key(|beside| beside.texel);
}

impl<'a> WayRun<'a> {
    fn new(points: &'a [WayPoint], stamp: f64, seed: u32) -> WayRun<'a> {
        let mut passed = vec![0.0];
        for pair in points.windows(2) {
            let length = pair[0].site.position.distance(pair[1].site.position);
            passed.push(passed[passed.len() - 1] + length);
        }
        let length = passed[passed.len() - 1];
        let count = (length / stamp).round().max(1.0);
        let ends = [points.first(), points.last()].map(|end| end.map(|end| end.site.position));
        WayRun {
            is_closed: points.len() > 2 && ends[0] == ends[1],
            stamp: length / count,
            passed,
            points,
            seed,
        }
    }

    fn length(&self) -> f64 {
        self.passed[self.passed.len() - 1]
    }

    /// Returns the sines of the angles between a part and the parts before and after it; 1 for angles of more than 90°.
    fn bends(&self, part: usize) -> [f64; 2] {
        let last = self.points.len() - 2;
        let way = |part: usize| direction(&self.points[part], &self.points[part + 1]);
        let sine = |other: usize| {
            let cosine = way(other).dot(way(part)).clamp(0.0, 1.0);
            (1.0 - cosine * cosine).sqrt()
        };
        let beside = |is_there: bool, other: usize, around: usize| match (is_there, self.is_closed) {
            (true, _) => sine(other),
            (false, true) => sine(around),
            (false, false) => 0.0,
        };
        [
            beside(part > 0, part.saturating_sub(1), last),
            beside(part < last, (part + 1).min(last), 0),
        ]
    }

    /// Returns the share of a texel between the ends of the ribbon, which are cut straight.
    fn inside(&self, beside: &RibbonTexel) -> f64 {
        if self.is_closed {
            return 1.0;
        }
        let inside = beside.along.min(self.length() - beside.along);
        (inside / beside.width + 0.5).clamp(0.0, 1.0)
    }

    /// Returns the pose of the pen at the place of the way that is nearest to a texel.
    fn pose(&self, beside: &RibbonTexel) -> PenPose {
        let part = beside.part as usize;
        let [from, to] = [part, part + 1].map(|index| (self.passed[index], self.points[index].pose));
        let share = ((beside.along - from.0) / (to.0 - from.0)).clamp(0.0, 1.0);
        PenPose::between([from.1, to.1], share as f32)
    }
}

impl Painter<'_> {
    /// Draws a ribbon along a way.
    pub(super) fn draw_ribbon(&mut self, way: &[WayPoint], used: &UsedBrush) {
        let radius = f64::from(used.brush.radius);
        let stamp = match &used.picture {
            Some((picture, _)) => 2.0 * radius * picture.half_sides().x / picture.half_sides().y,
            None => 2.0 * radius,
        };
        let seed = stroke_seed(way);
        for points in way.chunk_by(|_, next| !next.starts) {
            if points.len() > 1 {
                self.draw_run(&WayRun::new(points, stamp, seed), used);
            }
        }
    }

    fn draw_run(&mut self, run: &WayRun<'_>, used: &UsedBrush) {
        if run.length() <= 0.0 {
            return;
        }
        let mut all = Vec::new();
        let mut limit = FOUND_LIMIT;
        for part in 0..run.points.len() - 1 {
            if self.surface.is_stopped() {
                return;
            }
            self.find_beside(run, part, used, &mut all);
            if all.len() > limit {
                keep_nearest(&mut all);
                limit = all.len() + FOUND_LIMIT;
            }
        }
        keep_nearest(&mut all);
        let normals: Vec<DVec3> = run.points.iter().map(|point| self.normal_under(point.site)).collect();
        let mut stamps: BTreeMap<u32, Stamp> = BTreeMap::new();
        let Painter {
            surface,
            strengths,
            sight,
            ..
        } = self;
        let count = strengths.texel_count();
        for beside in &all {
            let part = beside.part as usize;
            let (from, to) = (&run.points[part], &run.points[part + 1]);
            let at = at_of(surface, beside);
            let normal = surface.connected().normal(at.triangle);
            let drawn = drawn(run, beside, at.position, normal, used, &mut stamps);
            if drawn.strength <= 0.0 {
                continue;
            }
            let texel = beside.texel as usize;
            let left = left_of(surface, sight, texel, count, &at, used, normals[part]);
            let added = AddedPaint {
                direction: used.kept.directions.then(|| direction(from, to).as_vec3().to_array()),
                color: left.color.or(drawn.color).filter(|_| used.kept.colors),
                ..AddedPaint::at_most(drawn.strength * left.share)
            };
            strengths.add(texel, &added);
        }
    }

    /// Finds the texels next to a part of the way whose distance from it is not larger than the radius.
    fn find_beside(&mut self, run: &WayRun<'_>, part: usize, used: &UsedBrush, found: &mut Vec<RibbonTexel>) {
        let (from, to) = (&run.points[part], &run.points[part + 1]);
        let length = run.passed[part + 1] - run.passed[part];
        if length <= 0.0 {
            return;
        }
        let radius = used.brush.radius_at(&from.pose).max(used.brush.radius_at(&to.pose));
        let plane = self.patches.lay(PatchRequest {
            from: from.site,
            to: Some(to.site),
            ahead: direction(from, to),
            radius,
            reaches_pieces: used.brush.reaches_pieces,
        });
        // If the part crosses a joint, for example from one board to the next, it is a straight line in the plane.
        let end = if plane.end == DVec2::ZERO {
            DVec2::new(length, 0.0)
        } else {
            plane.end
        };
        // At a bend, the texels on the outer side are nearest to the bend itself, so the part extends beyond its ends.
        let [before, behind] = run.bends(part).map(|bend| bend * radius + 2.0 * (plane.reach - radius));
        let within = [
            end.min(DVec2::ZERO) - DVec2::new(before, plane.reach),
            end.max(DVec2::ZERO) + DVec2::new(behind, plane.reach),
        ];
        let part = RibbonSegment {
            run,
            number: part,
            end,
            ends: [from, to].map(|point| point.site.position),
        };
        for laid in &self.patches.laid {
            for_texels(self.texels(), &laid.placed, within, |texel, at| {
                let beside = part.beside(texel as u32, at, laid);
                found.extend((beside.distance <= radius + 0.5 * at.width).then_some(beside));
            });
        }
    }
}

/// A part of the way in the plane of its patch.
struct RibbonSegment<'a> {
    run: &'a WayRun<'a>,
    number: usize,
    /// End in the plane; the start is the origin.
    end: DVec2,
    /// Ends in space.
    ends: [DVec3; 2],
}

impl RibbonSegment<'_> {
    /// Returns the position of a texel relative to the part.
    fn beside(&self, texel: u32, at: &At, laid: &LaidTriangle) -> RibbonTexel {
        let RibbonSegment { run, number, end, .. } = *self;
        let (is_first, is_last) = (number == 0, number + 2 == run.points.len());
        let square = end.length_squared();
        let share = at.plane.dot(end) / square;
        let side = end.perp_dot(at.plane);
        // The first and the last part are extended beyond the ends of the way, where nothing is drawn, so that the ends are straight.
        let is_beyond = !run.is_closed && ((is_first && share < 0.0) || (is_last && share > 1.0));
        let ahead = (share - share.clamp(0.0, 1.0)) * square.sqrt();
        let (share, distance) = if is_beyond {
            (share, side.abs() / square.sqrt())
        } else {
            let share = share.clamp(0.0, 1.0);
            let away = (at.plane - share * end).length_squared() + laid.rise * laid.rise;
            let apart = if laid.is_other {
                distance_to_line(at.position, self.ends)
            } else {
                0.0
            };
            (share, away.sqrt().max(apart))
        };
        let length = run.passed[number + 1] - run.passed[number];
        RibbonTexel {
            texel,
            part: number as u32,
            along: run.passed[number] + share * length,
            across: distance.copysign(side),
            rank: if is_beyond { distance.hypot(ahead) } else { distance },
            distance,
            triangle: at.triangle,
            weights: at.weights.as_vec2().to_array(),
            width: at.width,
        }
    }
}

/// Returns the position of a texel.
fn at_of(surface: &PaintSurface<'_>, beside: &RibbonTexel) -> At {
    let weights = DVec2::from(beside.weights.map(f64::from));
    let [first, second, third] = surface.connected().corners(beside.triangle);
    At {
        plane: DVec2::ZERO,
        position: first + weights.x * (second - first) + weights.y * (third - first),
        width: beside.width,
        triangle: beside.triangle,
        weights,
    }
}

/// Returns the stamp of a ribbon at a texel on a surface with this normal.
fn drawn(
    run: &WayRun<'_>,
    beside: &RibbonTexel,
    position: DVec3,
    normal: DVec3,
    used: &UsedBrush,
    stamps: &mut BTreeMap<u32, Stamp>,
) -> StampSample {
    let brush = &used.brush;
    let pose = run.pose(beside);
    let radius = brush.radius_at(&pose);
    let last = (run.length() / run.stamp).round() - 1.0;
    let number = (beside.along / run.stamp).floor().clamp(0.0, last);
    let side = if used.is_mirrored { -1.0 } else { 1.0 };
    let q = DVec2::new(
        (2.0 * (beside.along / run.stamp - number) - 1.0).clamp(-1.0, 1.0),
        side * beside.across / radius,
    );
    let strength = brush.strength_at(&pose) * run.inside(beside);
    if let Some((picture, part)) = &used.picture {
        let width = beside.width * picture.half_sides().y / radius;
        let stamped = picture.at(q, width, *part, PictureEnds::Joined);
        return StampSample {
            strength: stamped.strength * strength,
            color: stamped.color.or(Some(brush.color)),
        };
    }
    let spot = Spot {
        q,
        model: position / f64::from(brush.radius),
        normal,
        grain: grain_at(brush, position, beside.width),
        texel: (beside.width / radius).max(LEAST_TEXEL),
        fall: faded(beside.distance, radius, beside.width, brush, brush.hardness_at(&pose)),
    };
    let stamp = stamps
        .entry(number as u32)
        .or_insert_with(|| brush.tip.stamp([run.seed, number as u32]));
    StampSample {
        strength: strength * stamp.strength(&spot),
        color: None,
    }
}
