//! Height of a place along its rounded normal: where the line along this normal meets the height field.

use glam::DVec3;

/// Number of steps for the search along the line, over the distance of one height, and in total.
const STEPS_TO_HEIGHT: f64 = 8.0;
const STEPS_TO_LIMIT: f64 = 64.0;

/// Returns the signed length along `direction` at which the line from a place meets the height field. A length of 1 corresponds to a step
/// of 1 along the normals. `height(length)` is the height of the field at the point of the line with this length; outside of the field it
/// is `None`, and the last height inside is used. `limit` is the largest height in the field.
///
/// A tilted line meets a chamfer sooner than an upright one. The first crossing is used.
pub(super) fn meeting(limit: f64, height: impl Fn(f64) -> Option<f64>) -> f64 {
    let Some(first) = height(0.0).filter(|first| *first != 0.0 && first.is_finite()) else {
        return 0.0;
    };
    let sign = first.signum();
    let most = limit.max(first.abs());
    let step = (first.abs() / STEPS_TO_HEIGHT).max(most / STEPS_TO_LIMIT);
    // Height of the field above the line, with the sign of the place's height removed.
    let (mut length, mut gap) = (0.0, first.abs());
    loop {
        let next = length + step;
        let Some(found) = height(sign * next) else {
            // Beyond the field its last height continues.
            return sign * (length + gap);
        };
        let next_gap = sign * found - next;
        if next_gap <= 0.0 {
            return sign * (length + step * gap / (gap - next_gap));
        }
        (length, gap) = (next, next_gap);
        if length > most * 2.0 {
            return sign * length;
        }
    }
}

/// Returns the part of a direction that leads along the surface: the remainder after a step of 1 along the normal.
pub(super) fn lateral(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - normal * direction.dot(normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_meets_a_constant_height_a_chamfer_and_a_step() {
        for depth in [0.3, -0.3] {
            assert!((meeting(1.0, |_| Some(depth)) - depth).abs() < 1e-12, "a level field");
        }
        // A chamfer of 45 degrees and a width of 0.4, on the line at the edge: half of the height.
        let chamfer = meeting(0.4, |at| Some(-(0.4 - at.abs()).max(0.0)));
        assert!((chamfer + 0.2).abs() < 1e-12, "{chamfer}");
        let step = meeting(0.4, |at| Some(if at.abs() < 0.1 { -0.05 } else { -0.4 }));
        assert!((step + 0.05).abs() < 1e-2, "the first crossing: {step}");
        assert_eq!(meeting(1.0, |_| Some(0.0)), 0.0);
        assert_eq!(meeting(1.0, |_| None), 0.0);
        assert_eq!(
            meeting(0.3, |at| (at == 0.0).then_some(0.3)),
            0.3,
            "the last height goes on"
        );
    }
}
