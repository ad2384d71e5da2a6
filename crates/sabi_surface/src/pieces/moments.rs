//! Moments of a piece's surface and normals, as sums that do not depend on its triangulation.
//!
//! Uses no trigonometric functions, whose last bits may differ between systems.

use glam::{DMat3, DVec3};

/// Sums over a surface, relative to a point near it.
#[derive(Default)]
pub(super) struct Moments {
    area: f64,
    first: DVec3,
    second: DMat3,
    normals: DMat3,
}

/// The symmetric matrix `v vᵀ`.
fn square(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

impl Moments {
    /// Adds a triangle.
    pub(super) fn add(&mut self, [a, b, c]: [DVec3; 3]) {
        let normal = (b - a).cross(c - a);
        let double = normal.length();
        if double <= 0.0 {
            return;
        }
        let area = 0.5 * double;
        let sum = a + b + c;
        self.area += area;
        self.first += sum * (area / 3.0);
        // The mean of x xᵀ over a triangle is (a aᵀ + b bᵀ + c cᵀ + s sᵀ) / 12 with s the sum of its corners.
        self.second += (square(a) + square(b) + square(c) + square(sum)) * (area / 12.0);
        self.normals += square(normal / double) * area;
    }

    /// Returns the principal axes of the surface and of its normals; `None` without area.
    pub(super) fn axes(&self) -> Option<[Axes; 2]> {
        if !(self.area > 0.0 && self.area.is_finite()) {
            return None;
        }
        let mean = self.first / self.area;
        let spread = self.second * (1.0 / self.area) - square(mean);
        Some([Axes::of(spread), Axes::of(self.normals * (1.0 / self.area))])
    }
}

/// Eigenvectors of a symmetric matrix with their eigenvalues, the greatest first.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    pub(super) directions: DMat3,
    values: DVec3,
}

impl Axes {
    /// Computes them by Jacobi rotations (Golub and Van Loan, "Matrix Computations", 8.5).
    fn of(mut matrix: DMat3) -> Axes {
        let mut directions = DMat3::IDENTITY;
        let scale = matrix.to_cols_array().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for _ in 0..16 {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let off = matrix.col(q)[p];
                if off.abs() <= 1e-15 * scale {
                    continue;
                }
                let tau = (matrix.col(q)[q] - matrix.col(p)[p]) / (2.0 * off);
                let sign = if tau < 0.0 { -1.0 } else { 1.0 };
                let tangent = sign / (tau.abs() + (1.0 + tau * tau).sqrt());
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                let sine = tangent * cosine;
                let mut turn = DMat3::IDENTITY;
                turn.col_mut(p)[p] = cosine;
                turn.col_mut(q)[q] = cosine;
                turn.col_mut(q)[p] = sine;
                turn.col_mut(p)[q] = -sine;
                matrix = turn.transpose() * matrix * turn;
                directions *= turn;
            }
        }
        let mut order = [0, 1, 2];
        let value = |at: usize| matrix.col(at)[at];
        order.sort_by(|a, b| value(*b).total_cmp(&value(*a)));
        let [a, b, c] = order.map(|at| directions.col(at));
        Axes {
            directions: DMat3::from_cols(a, b, c),
            values: DVec3::from(order.map(value)),
        }
    }

    /// Returns the axis whose eigenvalue differs most from the other two, which may be equal.
    pub(super) fn distinct(&self) -> DVec3 {
        let is_first = self.values.x - self.values.y > self.values.y - self.values.z;
        self.directions.col(if is_first { 0 } else { 2 })
    }
}

/// Fourfold symmetry of the normals around an axis: a square bar has normals in two directions only, a round one in all.
pub(super) struct FourfoldSymmetry {
    along: DVec3,
    across: [DVec3; 2],
    /// Sum of area × (x + i y)⁴ / (x² + y²) of the normals.
    sum: [f64; 2],
    weight: f64,
}

impl FourfoldSymmetry {
    pub(super) fn new(along: DVec3) -> FourfoldSymmetry {
        let (first, second) = along.any_orthonormal_pair();
        FourfoldSymmetry {
            along,
            across: [first, second],
            sum: [0.0; 2],
            weight: 0.0,
        }
    }

    /// Adds a triangle.
    pub(super) fn add(&mut self, [a, b, c]: [DVec3; 3]) {
        let normal = (b - a).cross(c - a);
        let length = normal.length();
        let (x, y) = (normal.dot(self.across[0]), normal.dot(self.across[1]));
        let flat = x * x + y * y;
        if length <= 0.0 || flat <= 1e-12 * length * length {
            return;
        }
        let (real, imaginary) = (x * x - y * y, 2.0 * x * y);
        // Area × share of the normal that is across, twice.
        let share = 1.0 / (flat * length);
        self.sum[0] += (real * real - imaginary * imaginary) * share;
        self.sum[1] += 2.0 * real * imaginary * share;
        self.weight += flat / length;
    }

    /// Returns the axis and the two directions of the symmetry; `None` if there is none.
    pub(super) fn axes(&self) -> Option<DMat3> {
        let [x, y] = self.sum;
        let length = (x * x + y * y).sqrt();
        // The sum over a round bar is almost 0.
        if length <= 0.1 * self.weight {
            return None;
        }
        let [x, y] = half_turn(half_turn([x / length, y / length]));
        let [first, second] = self.across;
        let side = (first * x + second * y).try_normalize()?;
        Some(DMat3::from_cols(self.along, side, self.along.cross(side)))
    }
}

/// Returns the direction of half the angle of a direction, from −90° to 90°.
fn half_turn([x, y]: [f64; 2]) -> [f64; 2] {
    if x >= 0.0 {
        let cosine = ((1.0 + x) / 2.0).sqrt();
        [cosine, y / (2.0 * cosine)]
    } else {
        let sine = ((1.0 - x) / 2.0).sqrt();
        [y.abs() / (2.0 * sine), if y < 0.0 { -sine } else { sine }]
    }
}
