//! Strokes that change existing paint: smear, blur, sharpen, and clone.

use glam::{DQuat, DVec2, DVec3};
use sabi_surface::patch::{Site, walk};

use super::Canvas;
use super::grid::Grid;
use super::painter::Painter;
use super::patches::{LaidTriangle, PatchRequest};
use super::stamps::{StampPlace, stamps_of};
use super::strengths::KeptValues;
use super::texels::for_texels;
use super::used_brush::UsedBrush;
use crate::brush::TipDirection;
use crate::site::{passed, relocate_points};
use crate::stroke::{Action, Stroke, StrokePoint};
use crate::supplies::InputColors;

/// Maximum number of cells along a side of the plane around a stamp.
const SIDE_LIMIT: f64 = 256.0;
/// Maximum number of cells if the values are blurred anyway.
const BLURRED_SIDE_LIMIT: f64 = 64.0;
/// Standard deviation of the blur of a stamp, as a share of the radius.
const BLUR: f64 = 0.12;
/// Largest distance by which one stamp smears, as a share of the radius.
const SMEAR_LIMIT: f64 = 0.5;

/// A texel under a stamp.
struct StampedTexel {
    texel: usize,
    plane: DVec2,
    /// 0 to 1.
    strength: f64,
}

/// A change that a stroke makes.
#[derive(Clone, Copy)]
struct StrokeChange<'a> {
    action: Action,
    /// Node result that it copies; `None` if it changes the paint itself.
    input: Option<&'a InputColors<'a>>,
}

impl StrokeChange<'_> {
    /// Reads the values of a texel of the paint or of the result that is copied.
    fn read(&self, canvas: &Canvas, texel: usize, values: &mut [f32]) {
        match self.input {
            Some(input) => canvas.values_of_color(input(texel), values),
            None => canvas.read(texel, values),
        }
    }
}

/// Place from which a stamp copies.
#[derive(Clone, Copy)]
struct CloneSource {
    site: Site,
    /// Rotates directions at the first stamp to directions at the source.
    turn: DQuat,
}

/// Returns the lowest and the highest value of each channel under a stamp. Sharpening, however often it is repeated, stays
/// within them. Paint that is smeared or copied from outside of the stamp has its own range.
fn ranges_of(canvas: &Canvas, touched: &[StampedTexel], action: Action) -> Vec<[f32; 2]> {
    let mut ranges = vec![[f32::NEG_INFINITY, f32::INFINITY]; canvas.channel_count()];
    if action != Action::Sharpen {
        return ranges;
    }
    ranges.fill([f32::INFINITY, f32::NEG_INFINITY]);
    let mut values = vec![0.0; ranges.len()];
    for touched in touched {
        canvas.read(touched.texel, &mut values);
        for (range, value) in ranges.iter_mut().zip(&values) {
            *range = [range[0].min(*value), range[1].max(*value)];
        }
    }
    ranges
}

impl Painter<'_> {
    /// Changes existing paint along a stroke. Returns the number of its points that the model no longer has.
    pub(super) fn adjust(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        let (points, lost) = passed(self.surface, stroke);
        let kept = KeptValues {
            directions: false,
            colors: false,
        };
        let Some(used) = self.used(stroke, kept).filter(|_| !points.is_empty()) else {
            return lost;
        };
        let source = stroke.source.and_then(|source| {
            relocate_points(self.surface, &[source], f64::from(used.brush.radius))
                .0
                .pop()
        });
        let input = self.supplies.input.filter(|_| stroke.copies_input());
        let is_whole = source.is_some() == stroke.source.is_some() && input.is_some() == stroke.copies_input();
        if !is_whole || (stroke.action == Action::Clone && source.is_none() && input.is_none()) {
            return lost; // The source of the copy does not exist.
        }
        let change = StrokeChange {
            action: stroke.action,
            input,
        };
        self.strengths.forget_grains();
        for copy in self.with_copies(points, source, stroke, &used.brush) {
            self.sight.clear();
            self.adjust_along(canvas, change, &copy.points, copy.source, &used.on(&copy));
        }
        lost
    }

    fn adjust_along(
        &mut self,
        canvas: &mut Canvas,
        change: StrokeChange<'_>,
        points: &[StrokePoint],
        source: Option<StrokePoint>,
        used: &UsedBrush,
    ) {
        let way = self.way_of(points, &used.brush);
        let mut from = match (source, way.first()) {
            (Some(source), Some(first)) => Some(CloneSource {
                turn: DQuat::from_rotation_arc(self.normal_under(first.site), self.normal_under(source.site)),
                site: source.site,
            }),
            _ => None,
        };
        let mut before: Option<StampPlace> = None;
        for stamp in stamps_of(&way, used) {
            if self.surface.is_stopped() {
                return;
            }
            let way = before.as_ref().map_or(DVec3::ZERO, |before| {
                stamp.point.site.position - before.point.site.position
            });
            // Paint is not pulled across a gap.
            let pulled = if stamp.point.is_joined { way.length() } else { 0.0 };
            if let Some(from) = &mut from {
                // If the brush jumps, the source jumps as well.
                let target = from.site.position + from.turn * way;
                from.site = walk(self.surface.connected(), from.site, target);
            }
            self.adjust_under(canvas, change, &stamp, pulled, from, used);
            before = Some(stamp);
        }
    }

    fn adjust_under(
        &mut self,
        canvas: &mut Canvas,
        change: StrokeChange<'_>,
        stamp: &StampPlace,
        moved: f64,
        source: Option<CloneSource>,
        used: &UsedBrush,
    ) {
        let radius = used.brush.radius_at(&stamp.point.pose);
        let ahead = self.ahead(stamp, TipDirection::Stroke);
        let wanted = PatchRequest {
            from: stamp.point.site,
            to: None,
            ahead,
            // Blurring and smearing read paint from a larger area.
            radius: 1.5 * used.reach() * radius,
            reaches_pieces: used.brush.reaches_pieces,
        };
        let plane = self.patches.lay(wanted);
        let touched = self.touched(stamp, radius, used);
        let action = change.action;
        let pulled = DVec2::new(moved.min(SMEAR_LIMIT * radius), 0.0);
        let grid = self.values_for(canvas, change, source, wanted, plane.reach, radius);
        let offset = if action == Action::Smear { pulled } else { DVec2::ZERO };
        let mut found = vec![0.0; canvas.channel_count()];
        let mut own = found.clone();
        let ranges = ranges_of(canvas, &touched, action);
        for touched in touched {
            match &grid {
                Some(grid) if !grid.read(touched.plane - offset, &mut found) => continue,
                Some(_) => {}
                None => change.read(canvas, touched.texel, &mut found),
            }
            canvas.read(touched.texel, &mut own);
            if change.input.is_some() {
                canvas.keep_relief(&own, &mut found);
            }
            let strength = touched.strength as f32;
            let share = if action == Action::Sharpen { -strength } else { strength };
            for ((own, found), range) in own.iter_mut().zip(&found).zip(&ranges) {
                *own = (*own + share * (found - *own)).clamp(range[0], range[1]);
            }
            canvas.write(touched.texel, &own);
        }
    }

    /// Returns the new values for a stamp, on a grid around its middle; `None` if each texel uses the values at its own
    /// place, which needs no grid.
    fn values_for(
        &mut self,
        canvas: &Canvas,
        change: StrokeChange<'_>,
        source: Option<CloneSource>,
        wanted: PatchRequest,
        reach: f64,
        radius: f64,
    ) -> Option<Grid> {
        match (change.action, source) {
            (Action::Clone, None) => None,
            (Action::Clone, Some(source)) => {
                let laid = self.patches.laid.clone();
                let plane = self.patches.lay(PatchRequest {
                    from: source.site,
                    ahead: source.turn * wanted.ahead,
                    ..wanted
                });
                let grid = self.grid(canvas, change, plane.reach, radius, SIDE_LIMIT);
                self.patches.laid = laid;
                Some(grid)
            }
            (Action::Smear, _) => Some(self.grid(canvas, change, reach, radius, SIDE_LIMIT)),
            (Action::Paint | Action::Erase | Action::Blur | Action::Sharpen, _) => {
                let grid = self.grid(canvas, change, reach, radius, BLURRED_SIDE_LIMIT);
                Some(grid.blurred(BLUR * radius))
            }
        }
    }

    /// Returns the texels under a stamp on the patch that was laid last, with the strength of the stamp there.
    fn touched(&mut self, stamp: &StampPlace, radius: f64, used: &UsedBrush) -> Vec<StampedTexel> {
        let mut touched = Vec::new();
        self.for_stamped(stamp, radius, used, |texel, plane, strength| {
            touched.push(StampedTexel { texel, plane, strength });
        });
        touched
    }

    /// Returns the values that a change copies or changes, on the patch that was laid last.
    fn grid(&self, canvas: &Canvas, change: StrokeChange<'_>, reach: f64, radius: f64, side_limit: f64) -> Grid {
        let mut width = f64::INFINITY;
        let mut values = vec![0.0; canvas.channel_count()];
        let mut texels: Vec<(usize, DVec2)> = Vec::new();
        for laid in &self.patches.laid {
            self.for_own_texels(laid, reach, |texel, plane, texel_width| {
                width = width.min(texel_width);
                texels.push((texel, plane));
            });
        }
        // Cells are as wide as texels. The limit keeps a stretched chart with very small texels from needing many cells.
        let side = (2.0 * reach / width.max(1e-6 * radius)).clamp(4.0, side_limit);
        let mut grid = Grid::new(reach, side as usize, values.len());
        for (texel, plane) in texels {
            change.read(canvas, texel, &mut values);
            grid.add(plane, &values);
        }
        grid
    }

    /// Calls `visit` for the texels of a triangle within `reach`, without ghosts, with their positions and widths.
    fn for_own_texels(&self, laid: &LaidTriangle, reach: f64, mut visit: impl FnMut(usize, DVec2, f64)) {
        let within = [DVec2::splat(-reach), DVec2::splat(reach)];
        for_texels(self.texels(), &laid.placed, within, |texel, at| {
            if self.atlas.owners[texel] == laid.placed.triangle {
                visit(texel, at.plane, at.width);
            }
        });
    }
}
