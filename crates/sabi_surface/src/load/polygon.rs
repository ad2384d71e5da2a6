//! Triangulation of faces with more than three corners: fans for convex ones, ear clipping for others.

use glam::{DVec2, DVec3, Vec3};

/// Maximum number of point tests for a whole file, since concave faces with thousands of corners take quadratic time.
const MOST_TESTS: u64 = 200_000_000;

/// Number of corners from which a convex face is halved repeatedly. A fan of that many triangles would be a bundle of
/// slivers, which takes quadratic time wherever triangles are compared by their boxes.
const HALVED_CORNERS: usize = 256;

/// Remaining budget of tests.
pub(super) struct Budget(u64);

impl Default for Budget {
    fn default() -> Self {
        Budget(MOST_TESTS)
    }
}

impl Budget {
    /// Returns true if the budget is used up, so that further faces are cut without testing their ears.
    pub(super) fn is_spent(&self) -> bool {
        self.0 == 0
    }
}

/// Divides a face into `corners - 2` triangles of corner numbers, with the same winding as the face.
pub(super) fn triangulate(corners: &[[f32; 3]], budget: &mut Budget, mut emit: impl FnMut([usize; 3])) {
    let count = corners.len();
    if count > 3 {
        let flat = flattened(corners);
        if !is_convex(&flat) {
            return clip_ears(&flat, budget, emit);
        }
    }
    if count >= HALVED_CORNERS {
        return halve(count, emit);
    }
    for corner in 1..count.saturating_sub(1) {
        emit([0, corner, corner + 1]);
    }
}

/// Divides a convex face by repeatedly adding the middle corner between the ends of a triangle's edge.
fn halve(count: usize, mut emit: impl FnMut([usize; 3])) {
    let mut spans = vec![[0, count - 1]];
    while let Some([first, last]) = spans.pop() {
        let middle = first.midpoint(last);
        if middle == first {
            continue;
        }
        emit([first, middle, last]);
        spans.extend([[middle, last], [first, middle]]);
    }
}

/// Projects a face along its normal (Newell 1972), so that it is counter-clockwise.
fn flattened(corners: &[[f32; 3]]) -> Vec<DVec2> {
    let at = |corner: usize| Vec3::from(corners[corner % corners.len()]).as_dvec3();
    let origin = at(0);
    let normal = (0..corners.len())
        .map(|c| (at(c) - origin).cross(at(c + 1) - origin))
        .sum::<DVec3>();
    let Some(normal) = normal.try_normalize() else {
        return vec![DVec2::ZERO; corners.len()];
    };
    let (across, along) = normal.any_orthonormal_pair();
    (0..corners.len())
        .map(|c| DVec2::new((at(c) - origin).dot(across), (at(c) - origin).dot(along)))
        .collect()
}

/// Twice the signed area.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_convex(flat: &[DVec2]) -> bool {
    let count = flat.len();
    let at = |corner: usize| flat[corner % count];
    // Rounding may make corners on a straight line slightly concave.
    let slack = -1e-9 * flat.iter().map(|at| at.length_squared()).fold(0.0, f64::max);
    (0..count).all(|c| area(at(c), at(c + 1), at(c + 2)) >= slack)
        // Only left turns, and not more than one revolution as in a star polygon.
        && (1..count - 1).all(|c| area(at(0), at(c), at(c + 1)) >= slack)
}

fn clip_ears(flat: &[DVec2], budget: &mut Budget, mut emit: impl FnMut([usize; 3])) {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut start = 0;
    while left.len() > 3 {
        if budget.is_spent() {
            return halve(left.len(), |triangle| emit(triangle.map(|corner| left[corner])));
        }
        let count = left.len();
        // The search continues after the last ear, so that not all triangles share one corner.
        let ear = (0..count)
            .map(|step| (start + step) % count)
            .find(|corner| is_ear(flat, &left, *corner, budget));
        // A self-intersecting face may have no ear. In that case any corner is cut off.
        let ear = ear.unwrap_or(start % count);
        emit([left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]]);
        left.remove(ear);
        start = ear % left.len();
    }
    emit([left[0], left[1], left[2]]);
}

/// Returns true if the triangle at a corner of the remaining polygon is an ear, i.e. lies inside it. Always true once the
/// budget is used up. Each call costs at least one test.
fn is_ear(flat: &[DVec2], left: &[usize], corner: usize, budget: &mut Budget) -> bool {
    let count = left.len();
    let at = |corner: usize| flat[left[corner % count]];
    let [before, here, after] = [at(corner + count - 1), at(corner), at(corner + 1)];
    if budget.is_spent() {
        return true;
    }
    if area(before, here, after) <= 0.0 {
        budget.0 = budget.0.saturating_sub(1);
        return false;
    }
    budget.0 = budget.0.saturating_sub(count as u64);
    (corner + 2..corner + count - 1).map(at).all(|other| {
        let is_corner = other == before || other == here || other == after;
        let outside =
            area(before, here, other) < 0.0 || area(here, after, other) < 0.0 || area(after, before, other) < 0.0;
        is_corner || outside
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[[f32; 3]]) -> Vec<[usize; 3]> {
        let mut triangles = Vec::new();
        triangulate(corners, &mut Budget::default(), |triangle| triangles.push(triangle));
        triangles
    }

    fn area_of(corners: &[[f32; 3]], [a, b, c]: [usize; 3]) -> f64 {
        let at = |corner: usize| Vec3::from(corners[corner]).as_dvec3();
        (at(b) - at(a)).cross(at(c) - at(a)).z / 2.0
    }

    #[test]
    fn a_convex_face_becomes_a_fan() {
        let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&face), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_convex_face_of_many_corners_does_not_become_slivers() {
        let circle = |count: usize| -> Vec<[f32; 3]> {
            let angle = |corner: usize| corner as f32 * std::f32::consts::TAU / count as f32;
            let corners = (0..count).map(|corner| angle(corner).sin_cos());
            corners.map(|(y, x)| [x, y, 0.0]).collect()
        };
        let face = circle(30_000);
        let triangles = cut(&face);
        assert_eq!(triangles.len(), face.len() - 2);
        let covered: f64 = triangles.iter().map(|triangle| area_of(&face, *triangle)).sum();
        assert!((covered - std::f64::consts::PI).abs() < 1e-4, "{covered}");
        // Three neighboring corners lie on a line except for rounding.
        assert!(triangles.iter().all(|triangle| area_of(&face, *triangle) > -1e-10));
        // Squares of the longest edges. Those of a fan would add up to 60 000.
        let long = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|corner| Vec3::from(face[corner]));
            a.distance_squared(b)
                .max(b.distance_squared(c))
                .max(c.distance_squared(a))
        };
        let total: f32 = triangles.iter().map(long).sum();
        assert!(total < 60.0, "{total}");
    }

    #[test]
    fn the_work_for_concave_faces_is_limited() {
        // A spiral with two arms, most of whose corners are not ears.
        let arm = |corner: usize, width: f32| {
            let turn = corner as f32 * 0.01;
            let (y, x) = turn.sin_cos();
            [(turn + width) * x, (turn + width) * y, 0.0]
        };
        let mut face: Vec<[f32; 3]> = (0..50_000).map(|corner| arm(corner, 1.0)).collect();
        face.extend((0..50_000).rev().map(|corner| arm(corner, 0.0)));
        let mut budget = Budget(1_000_000);
        let mut count = 0;
        triangulate(&face, &mut budget, |_| count += 1);
        assert!(budget.is_spent());
        assert_eq!(count, face.len() - 2);
    }

    #[test]
    fn a_concave_face_is_covered_exactly_once() {
        let arrow = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 0.0]];
        let comb = [
            [0.0, 0.0, 0.0],
            [5.0, 0.0, 0.0],
            [5.0, 2.0, 0.0],
            [4.0, 2.0, 0.0],
            [4.0, 1.0, 0.0],
            [3.0, 1.0, 0.0],
            [3.0, 2.0, 0.0],
            [2.0, 2.0, 0.0],
            [2.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
        ];
        for (face, area) in [(&arrow[..], 1.0), (&comb[..], 8.0)] {
            let triangles = cut(face);
            assert_eq!(triangles.len(), face.len() - 2);
            assert!(
                triangles.iter().all(|triangle| area_of(face, *triangle) >= 0.0),
                "{triangles:?}"
            );
            assert_eq!(
                triangles.iter().map(|triangle| area_of(face, *triangle)).sum::<f64>(),
                area
            );
        }
    }

    #[test]
    fn any_face_gives_two_triangles_fewer_than_corners() {
        let star: Vec<[f32; 3]> = (0..5)
            .map(|k| (k as f32 * 4.0 * std::f32::consts::PI / 5.0).sin_cos())
            .map(|(y, x)| [x, y, 0.0])
            .collect();
        let bow = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let nothing = [[f32::NAN; 3]; 6];
        let point = [[1.0; 3]; 5];
        let huge = [
            [3e38, 0.0, 0.0],
            [-3e38, 1.0, 0.0],
            [3e38, 3e38, 0.0],
            [0.0, -3e38, 3e38],
        ];
        for face in [&star[..], &bow, &nothing, &point, &huge] {
            assert_eq!(cut(face).len(), face.len() - 2);
        }
    }
}
