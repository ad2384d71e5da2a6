//! Levels of the surface on which passes run.

use std::fmt;

/// Level of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// Texels of an atlas. Level 0 is the finest, and each further level has half as many texels along a side.
    Texels(u32),
    /// Points evenly distributed over the surface. Level 0 has the widest spacing, and each further level half the spacing
    /// of the one before.
    Points(u32),
}

impl Level {
    /// Texels of the maps themselves.
    pub const FINEST: Level = Level::Texels(0);

    /// Returns bytes that are different for every level, for keys.
    pub fn bytes(self) -> [u8; 5] {
        let (kind, number) = match self {
            Level::Texels(number) => (0, number),
            Level::Points(number) => (1, number),
        };
        let [a, b, c, d] = number.to_le_bytes();
        [kind, a, b, c, d]
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Level::Texels(number) => write!(f, "{number}"),
            Level::Points(number) => write!(f, "{number} of points"),
        }
    }
}

/// Number of texels for the spacing of points. With fewer texels, a cell does not represent the surface around a point well.
const TEXELS_ACROSS: f64 = 4.0;

/// Widths of the levels of a surface that may be used, working units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelWidths {
    /// Width of a texel on the finest level.
    pub finest: f64,
    /// Number of the coarsest level of texels.
    pub coarsest: u32,
    /// Spacing of the widest points.
    pub widest_points: f64,
    /// Number of levels of points.
    pub point_levels: u32,
}

impl LevelWidths {
    /// Widths of levels of texels alone.
    pub const fn of_texels(finest: f64, coarsest: u32) -> LevelWidths {
        LevelWidths {
            finest,
            coarsest,
            widest_points: 0.0,
            point_levels: 0,
        }
    }

    /// Width of a texel, or spacing of points.
    pub fn of(&self, level: Level) -> f64 {
        match level {
            Level::Texels(number) => self.finest * f64::from(1_u32 << number),
            Level::Points(number) => self.widest_points / f64::from(1_u32 << number),
        }
    }

    /// Returns the moves that bring a plane from one level to another: by way of the finest level, and to points by way of
    /// the texels that form their cells.
    pub(crate) fn moves(&self, from: Level, to: Level) -> Vec<[Level; 2]> {
        let cells = match to {
            Level::Points(number) => self.cells_of_points(number),
            Level::Texels(_) => to,
        };
        let mut stops = vec![from];
        if from != cells {
            stops.extend([Level::FINEST, cells]);
        }
        stops.push(to);
        stops.dedup();
        stops.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// Level of texels that the cells of points are made of.
    pub fn cells_of_points(&self, number: u32) -> Level {
        self.coarsest_texels_within(self.of(Level::Points(number)) / TEXELS_ACROSS)
    }

    /// Returns the coarsest level whose texels are not wider than this; the finest level if all are wider.
    pub(crate) fn coarsest_texels_within(&self, widest: f64) -> Level {
        let fits = |level: &Level| self.of(*level) <= widest;
        let levels = (0..=self.coarsest).map(Level::Texels);
        levels.take_while(fits).last().unwrap_or(Level::FINEST)
    }

    /// Widest points with no more than this spacing, if there are any.
    pub(crate) fn widest_points_within(&self, widest: f64) -> Option<Level> {
        (0..self.point_levels)
            .map(Level::Points)
            .find(|level| self.of(*level) <= widest)
    }
}
