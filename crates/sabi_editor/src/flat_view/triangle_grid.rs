//! Triangles of a texture set, found by place.

use glam::DVec2;

/// Most cells along a side of the grid.
const SIDE_LIMIT: usize = 256;
/// Most cells in which a triangle is listed. A triangle over more of them is tried at every place: where textures repeat, each may
/// cover the whole square.
const CELLS_LIMIT: usize = 64;
/// Widening of boxes, as a share of their larger side, or of the unit square if that is larger: more than the distance at which a
/// place beyond the edges of a triangle still counts as inside, and more than rounding.
const MARGIN: f64 = 1e-5;

/// A grid over the boxes of triangles.
pub(super) struct TriangleGrid {
    low: DVec2,
    /// Cells in a unit, along each axis.
    density: DVec2,
    /// Cells along a side.
    side: usize,
    /// Triangles whose boxes touch each cell, row by row, in rising order.
    cells: Vec<Vec<u32>>,
    /// Triangles that touch too many cells, in rising order.
    wide: Vec<u32>,
}

impl TriangleGrid {
    /// Sorts triangles by their boxes, lower and upper corner. The triangles come in rising order; boxes that are not finite
    /// hold no place.
    pub(super) fn new(boxes: impl Iterator<Item = (u32, [DVec2; 2])>) -> TriangleGrid {
        let finite = boxes.filter(|(_, [low, high])| low.is_finite() && high.is_finite());
        let widened = finite.map(|(triangle, [low, high])| {
            let margin = MARGIN * (high - low).max_element().max(1.0);
            (triangle, [low - margin, high + margin])
        });
        let boxes: Vec<(u32, [DVec2; 2])> = widened.collect();
        let low = boxes.iter().map(|(_, [low, _])| *low).reduce(DVec2::min);
        let high = boxes.iter().map(|(_, [_, high])| *high).reduce(DVec2::max);
        let (low, high) = low.zip(high).unwrap_or((DVec2::ZERO, DVec2::ONE)); // Without boxes, a single empty cell.
        let side = (boxes.len() as f64).sqrt().clamp(1.0, SIDE_LIMIT as f64) as usize;
        let mut grid = TriangleGrid {
            density: DVec2::splat(side as f64) / (high - low),
            cells: vec![Vec::new(); side * side],
            wide: Vec::new(),
            low,
            side,
        };
        for (triangle, corners) in boxes {
            let [[left, top], [right, bottom]] = corners.map(|corner| grid.cell(corner));
            if (right - left + 1) * (bottom - top + 1) > CELLS_LIMIT {
                grid.wide.push(triangle);
                continue;
            }
            for row in top..=bottom {
                for column in left..=right {
                    grid.cells[row * side + column].push(triangle);
                }
            }
        }
        grid
    }

    /// Column and row of the cell of a place; of the nearest one for a place beside the grid.
    fn cell(&self, at: DVec2) -> [usize; 2] {
        let place = (at - self.low) * self.density;
        [place.x, place.y].map(|along| (along as usize).min(self.side - 1))
    }

    /// Result of `find` for the lowest triangle near a place for which it gives one.
    pub(super) fn first<T>(&self, at: DVec2, find: impl Fn(u32) -> Option<T>) -> Option<T> {
        let [column, row] = self.cell(at);
        let first_of = |triangles: &[u32]| {
            let mut triangles = triangles.iter().copied();
            triangles.find_map(|triangle| Some((triangle, find(triangle)?)))
        };
        let found = [first_of(&self.cells[row * self.side + column]), first_of(&self.wide)];
        let lowest = found.into_iter().flatten().min_by_key(|(triangle, _)| *triangle);
        lowest.map(|(_, found)| found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Box of a number: small ones all over the square, and every eleventh across most of it.
    fn square(number: u32) -> [DVec2; 2] {
        let spread = |step: f64| (f64::from(number) * step).fract();
        let half = if number.is_multiple_of(11) { 0.4 } else { 0.01 };
        let middle = DVec2::new(spread(0.754_877_666), spread(0.569_840_291));
        [middle - half, middle + half]
    }

    #[test]
    fn the_first_triangle_is_that_of_a_search_through_all_of_them() {
        const COUNT: u32 = 600;
        let grid = TriangleGrid::new((0..COUNT).map(|number| (number, square(number))));
        assert!(!grid.wide.is_empty() && grid.cells.iter().any(|cell| !cell.is_empty()));
        // Places in the square and beyond it on all sides.
        for step in 0..3600_u32 {
            let at = 0.025 * DVec2::new(f64::from(step % 60), f64::from(step / 60)) - 0.25;
            for least in [0, COUNT / 2] {
                let find = |number: u32| {
                    let [low, high] = square(number);
                    let is_inside = at.cmpge(low).all() && at.cmple(high).all();
                    (is_inside && number >= least).then_some(number)
                };
                assert_eq!(grid.first(at, find), (0..COUNT).find_map(find), "at {at}");
            }
        }
    }

    #[test]
    fn boxes_that_are_points_or_not_finite_are_handled() {
        let empty = TriangleGrid::new(std::iter::empty());
        assert_eq!(empty.first(DVec2::ZERO, Some), None);
        let boxes = [[DVec2::NAN; 2], [DVec2::ONE; 2], [DVec2::ZERO, DVec2::INFINITY]];
        let grid = TriangleGrid::new((0..).zip(boxes));
        assert_eq!(grid.first(DVec2::ONE, Some), Some(1));
        assert_eq!(grid.first(DVec2::NAN, |_| None::<u32>), None);
    }
}
