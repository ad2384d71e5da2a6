//! Visibility of places for the artist while a stroke was drawn.

use glam::DVec3;

use super::texels::At;
use crate::brush_limits::{BrushLimits, Eye};
use crate::surface::PaintSurface;

/// Range of cosines between the surface normal and the ray to the eye in which places that are seen nearly edge-on fade.
const EDGE_ON: [f64; 2] = [0.05, 0.25];
/// Minimum cosine between the surface normal and the ray to the eye at which a place is visible, from the front or from the back.
const LEAST_SEEN: f64 = 0.02;
/// Height above the surface at which a ray starts, in texel widths, so that it does not hit the triangle that it leaves.
const LIFT: f64 = 1.0;

/// Visibility of the places under a stroke. Results are kept until the next stroke.
#[derive(Default)]
pub(super) struct Sight {
    /// Share of the strength that each texel receives; negative if it has not been computed. Empty until the first stroke
    /// with such a limit.
    shares: Vec<f32>,
    /// Texels whose share has been computed.
    known: Vec<u32>,
}

/// Eye of a stroke, with the limits that depend on it.
#[derive(Clone, Copy)]
pub(super) struct EyeLimits {
    pub(super) eye: Eye,
    pub(super) limits: BrushLimits,
}

impl EyeLimits {
    /// Returns `None` if no limit depends on the eye. A stroke without an eye, which was drawn in the 2D view, paints everything.
    pub(super) fn of(eye: Option<Eye>, limits: BrushLimits) -> Option<EyeLimits> {
        let eye = eye.filter(|eye| eye.is_finite() && (limits.front_only || limits.seen_only))?;
        Some(EyeLimits { eye, limits })
    }
}

impl Sight {
    /// Forgets all results, since the eye has changed.
    pub(super) fn clear(&mut self) {
        for texel in self.known.drain(..) {
            self.shares[texel as usize] = -1.0;
        }
    }

    /// Returns the shares computed so far, by texel.
    pub(super) fn saved(&self) -> Vec<(u32, f32)> {
        let known = self.known.iter();
        known.map(|texel| (*texel, self.shares[*texel as usize])).collect()
    }

    /// Restores shares that were saved, for an atlas of this many texels.
    pub(super) fn restore(&mut self, saved: &[(u32, f32)], texels: usize) {
        if self.shares.is_empty() && !saved.is_empty() {
            self.shares = vec![-1.0; texels];
        }
        for (texel, share) in saved {
            self.shares[*texel as usize] = *share;
            self.known.push(*texel);
        }
    }

    /// Returns the share of the strength that a texel receives, 0 to 1.
    pub(super) fn share(
        &mut self,
        surface: &PaintSurface<'_>,
        texel: usize,
        texels: usize,
        at: &At,
        watched: &EyeLimits,
    ) -> f64 {
        if self.shares.is_empty() {
            self.shares = vec![-1.0; texels];
        }
        if self.shares[texel] < 0.0 {
            self.shares[texel] = found(surface, at, watched) as f32;
            self.known.push(texel as u32);
        }
        f64::from(self.shares[texel])
    }
}

fn found(surface: &PaintSurface<'_>, at: &At, watched: &EyeLimits) -> f64 {
    let (way, distance) = match watched.eye {
        Eye::Place(place) => {
            let way = DVec3::from(place.map(f64::from)) - at.position;
            (way.normalize_or_zero(), way.length())
        }
        Eye::Toward(direction) => (DVec3::from(direction.map(f64::from)).normalize_or_zero(), f64::MAX),
    };
    let mut share = 1.0;
    if watched.limits.front_only {
        let [from, to] = EDGE_ON;
        let t = ((surface.smooth_normal(at.triangle, at.weights).dot(way) - from) / (to - from)).clamp(0.0, 1.0);
        share = t * t * (3.0 - 2.0 * t);
    }
    if share > 0.0 && watched.limits.seen_only {
        let normal = surface.connected().normal(at.triangle);
        let origin = at.position + LIFT * at.width * normal.dot(way).signum() * normal;
        let is_edge_on = normal.dot(way).abs() < LEAST_SEEN;
        let is_hidden = is_edge_on
            || surface.bvh().any(
                origin.as_vec3().to_array(),
                way.as_vec3().to_array(),
                distance.min(f64::from(f32::MAX)) as f32,
            );
        if is_hidden {
            share = 0.0;
        }
    }
    share
}
