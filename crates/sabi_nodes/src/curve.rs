//! Curves in the form that shaders read.

use sabi_curve::with_slopes;

/// Returns the components in WGSL of a curve through `points` (x, y; x ascending): for each point x, y, slope ([`with_slopes`]) and 1. The
/// remaining points up to `room` repeat the last point, with 0 in place of 1. A curve without points is 0 everywhere.
pub fn curve_points(points: &[[f32; 2]], room: usize) -> Vec<f32> {
    let wide: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::from)).collect();
    let slopes = with_slopes(&wide).into_iter().map(|[.., slope]| slope);
    let mut read: Vec<[f32; 4]> = points
        .iter()
        .zip(slopes)
        .map(|([x, y], slope)| [*x, *y, slope as f32, 1.0])
        .collect();
    let [x, y, ..] = read.last().copied().unwrap_or([0.0; 4]);
    read.resize(room, [x, y, 0.0, 0.0]);
    read.into_flattened()
}

#[cfg(test)]
mod tests {
    use super::curve_points;

    #[test]
    fn unused_room_repeats_the_last_point() {
        let read = curve_points(&[[0.0, 0.2], [1.0, 0.7]], 4);
        assert_eq!(read.len(), 16);
        assert_eq!(read[3], 1.0);
        assert_eq!(read[8..], [1.0, 0.7, 0.0, 0.0, 1.0, 0.7, 0.0, 0.0]);
    }
}
