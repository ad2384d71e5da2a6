//! Tips: the shapes of a brush's stamps.
//!
//! A stamp is created once from the number of its stroke and its own number in the stroke, and is then evaluated for each
//! texel. It is a pure function, so the same stroke gives the same bytes everywhere.

mod bands;
mod cracks;
mod drops;
mod grains;
mod hairs;
mod noise;
mod plants;
mod prints;
mod spot;
#[cfg(test)]
mod tests;
mod wear;

use glam::DVec3;
use serde::{Deserialize, Serialize};

pub(crate) use noise::random;
pub(crate) use spot::Spot;

/// Shape of a stamp. All but the round one are drawn as single stamps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tip {
    /// A disk.
    #[default]
    Round,
    /// A disk that fades like the cone of an airbrush.
    Soft,
    /// A square.
    Square,
    /// A disk with a grain that keeps its place on the model.
    Chalk,
    /// Print of a sponge: walls between pores of several sizes.
    Sponge,
    /// Fine dots, fewer toward the border.
    Spray,
    /// Hairs that draw separate lines along the stroke.
    Bristles,
    /// Broken streaks of a brush that has hardly any paint left.
    DryBrush,
    /// Drops of different sizes.
    Splatter,
    /// Runs that hang down from a wet edge, each with a drop at its end.
    Drips,
    /// Streaks of rain and rust that fade downward.
    Leaks,
    /// Stain of water that dried, with a dark rim.
    Ring,
    /// Thin scratches of different length.
    Scratches,
    /// Worn patch of many short, fine scratches.
    Scuffs,
    /// A single groove with torn edges.
    Gouge,
    /// A crack that branches.
    Cracks,
    /// Net of cracks in dried paint that keeps its place on the model.
    Crackle,
    /// Chips of paint with straight, sharp edges.
    Flakes,
    /// Pits of corrosion in clusters.
    Pits,
    /// Print of a fingertip.
    Fingerprint,
    /// Hairs, crumbs and fluff.
    Lint,
    /// Cushions of moss that keep their place on the model.
    Moss,
    /// Rosettes of lichen with lobed rims.
    Lichen,
    /// A few fallen leaves.
    Leaves,
    /// Bead of a weld.
    Weld,
    /// Stitches of thread.
    Stitches,
    /// Twisted rope.
    Rope,
    /// Heads of rivets.
    Rivets,
}

impl Tip {
    /// All tips with their titles, in the order of the list in the user interface.
    pub const ALL: [(Tip, &'static str); 28] = [
        (Tip::Round, "Round"),
        (Tip::Soft, "Soft"),
        (Tip::Square, "Square"),
        (Tip::Chalk, "Chalk"),
        (Tip::Sponge, "Sponge"),
        (Tip::Spray, "Spray"),
        (Tip::Bristles, "Bristles"),
        (Tip::DryBrush, "Dry brush"),
        (Tip::Splatter, "Splatter"),
        (Tip::Drips, "Drips"),
        (Tip::Leaks, "Leaks"),
        (Tip::Ring, "Water ring"),
        (Tip::Scratches, "Scratches"),
        (Tip::Scuffs, "Scuffs"),
        (Tip::Gouge, "Gouge"),
        (Tip::Cracks, "Cracks"),
        (Tip::Crackle, "Crackle"),
        (Tip::Flakes, "Flakes"),
        (Tip::Pits, "Pits"),
        (Tip::Fingerprint, "Fingerprint"),
        (Tip::Lint, "Lint"),
        (Tip::Moss, "Moss"),
        (Tip::Lichen, "Lichen"),
        (Tip::Leaves, "Leaves"),
        (Tip::Weld, "Weld"),
        (Tip::Stitches, "Stitches"),
        (Tip::Rope, "Rope"),
        (Tip::Rivets, "Rivets"),
    ];

    /// Returns the function for the grain of the model on which the tip depends, by position and width of a texel, both in radii of the
    /// brush at full pressure. The grain is the same for all stamps of a stroke, which evaluate a place many times.
    pub(crate) fn grain(self) -> Option<fn(DVec3, f64) -> f64> {
        (self == Tip::Chalk).then_some(grains::chalk_grain as fn(DVec3, f64) -> f64)
    }

    /// True for tips that are meant as bands along a way ([`crate::Area::Ribbon`]).
    pub fn is_band(self) -> bool {
        matches!(self, Tip::Weld | Tip::Stitches | Tip::Rope | Tip::Rivets)
    }

    /// Returns true if overlapping stamps add up until they cover fully. Stamps of other tips add up only to the tip's own
    /// strength at a place, so that its shades are still visible after many stamps.
    pub(crate) fn builds_up(self) -> bool {
        use Tip::*;
        matches!(self, Round | Soft | Square | Chalk | Spray | Bristles | Splatter)
    }

    /// Creates a stamp from the number of its stroke and its own number in the stroke.
    pub(crate) fn stamp(self, seeds: [u32; 2]) -> Stamp {
        Stamp(match self {
            Tip::Round | Tip::Square => Box::new(|spot| spot.fall),
            Tip::Soft => Box::new(|spot| spot.fall * spot.fall),
            Tip::Chalk => Box::new(grains::chalk()),
            Tip::Sponge => Box::new(grains::sponge(seeds)),
            Tip::Spray => Box::new(grains::spray(seeds)),
            Tip::Bristles => Box::new(hairs::bristles(seeds)),
            Tip::DryBrush => Box::new(hairs::dry_brush(seeds)),
            Tip::Splatter => Box::new(drops::splatter(seeds)),
            Tip::Drips => Box::new(drops::drips(seeds)),
            Tip::Leaks => Box::new(drops::leaks(seeds)),
            Tip::Ring => Box::new(drops::ring(seeds)),
            Tip::Scratches => Box::new(wear::scratches(seeds)),
            Tip::Scuffs => Box::new(hairs::scuffs(seeds)),
            Tip::Gouge => Box::new(wear::gouge(seeds)),
            Tip::Cracks => Box::new(cracks::cracks(seeds)),
            Tip::Crackle => Box::new(cracks::crackle()),
            Tip::Flakes => Box::new(wear::flakes(seeds)),
            Tip::Pits => Box::new(wear::pits(seeds)),
            Tip::Fingerprint => Box::new(prints::fingerprint(seeds)),
            Tip::Lint => Box::new(hairs::lint(seeds)),
            Tip::Moss => Box::new(plants::moss()),
            Tip::Lichen => Box::new(plants::lichen(seeds)),
            Tip::Leaves => Box::new(plants::leaves(seeds)),
            Tip::Weld => Box::new(bands::weld(seeds)),
            Tip::Stitches => Box::new(bands::stitches(seeds)),
            Tip::Rope => Box::new(bands::rope(seeds)),
            Tip::Rivets => Box::new(bands::rivets(seeds)),
        })
    }
}

/// A single stamp.
pub(crate) struct Stamp(Box<dyn Fn(&Spot) -> f64>);

impl Stamp {
    /// Returns the strength at a place, 0 to 1; 0 where the brush has faded to zero.
    pub(crate) fn strength(&self, spot: &Spot) -> f64 {
        if spot.fall <= 0.0 {
            return 0.0;
        }
        (self.0)(spot).clamp(0.0, 1.0)
    }
}
