//! Which atlas texel feeds each pixel of a texture set.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT, TILE};

/// Stands for no texel or no pixel.
pub const NONE: u32 = u32::MAX;

/// What wrote a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cover {
    /// Nothing: padding may.
    Empty,
    /// A texel of the ring around a chart: the surface as it goes on over the seam.
    Ghost,
    /// A texel of a chart.
    Owned,
}

/// One texture set of a model: a material, or one UV tile of a material that uses several, or the one sheet that all
/// materials share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SetKey {
    /// An index into the model's materials, or 0 for their one sheet.
    pub material: u32,
    /// UV tile, v downward; `[0, 0]` is the unit square.
    pub uv_tile: [i32; 2],
    /// UDIM number, when the material uses more than one tile: 1001 is the unit square, +1 to the right, +10 upward.
    pub udim: Option<u32>,
}

/// A texture set's pixels and where their values come from.
#[derive(Clone, Debug, PartialEq)]
pub struct SetLayout {
    /// Which set this is.
    pub key: SetKey,
    /// Pixels across and down.
    pub size: u32,
    /// For each pixel, row by row from the top, the atlas texel (page by page, row by row) or [`NONE`].
    pub source: Vec<u32>,
    /// For each pixel what wrote it.
    pub cover: Vec<Cover>,
    /// What else claims a pixel the way [`SetLayout::source`] does: pixel and texel, pixels rising. Empty unless asked for.
    pub shared: Vec<(u32, u32)>,
    /// Owned texels that found their pixel taken by a chart before theirs: overlapping or tiling UVs.
    pub collisions: u64,
}

/// The UDIM number of a tile, where it has one: ten columns, rows upward.
fn udim([u, v]: [i32; 2]) -> Option<u32> {
    // v grows downward, so the tile above the unit square is −1; four digits end at row 899.
    ((0..10).contains(&u) && (-899..=0).contains(&v)).then(|| 1001 + u as u32 + 10 * v.unsigned_abs())
}

/// The texture sets of an atlas, by material and tile. A material whose charts lie in several UDIM tiles has a set for
/// each. Otherwise it has one, and charts outside the unit square wrap onto it as renderers repeat a texture.
pub fn set_keys(atlas: &Atlas) -> Vec<SetKey> {
    let mut tiles: BTreeMap<u32, BTreeSet<[i32; 2]>> = BTreeMap::new();
    for chart in &atlas.charts {
        let of_material = tiles.entry(chart.sheet).or_default();
        if chart.texels > 0 {
            of_material.insert(chart.uv_tile);
        }
    }
    let mut keys = Vec::new();
    for (material, tiles) in tiles {
        let numbers: Option<Vec<u32>> = tiles.iter().map(|&tile| udim(tile)).collect();
        match numbers {
            Some(numbers) if numbers.len() > 1 => {
                let of_tile = |(uv_tile, number)| SetKey {
                    material,
                    uv_tile,
                    udim: Some(number),
                };
                let mut of_material: Vec<SetKey> = tiles.into_iter().zip(numbers).map(of_tile).collect();
                of_material.sort_by_key(|key| key.udim);
                keys.extend(of_material);
            }
            _ => keys.push(SetKey {
                material,
                uv_tile: tiles.first().copied().unwrap_or([0, 0]),
                udim: None,
            }),
        }
    }
    keys
}

/// All layouts at once, in the order of [`set_keys`]. Five bytes a pixel each: with many materials rather build them one by
/// one.
pub fn layouts(atlas: &Atlas) -> Vec<SetLayout> {
    let keys = set_keys(atlas).into_iter();
    keys.map(|key| SetLayout::new(atlas, key)).collect()
}

impl SetLayout {
    /// The layout of one set. Owned texels go before ghosts, lower charts before higher ones. Ghosts outside the tile are
    /// dropped; an owned texel outside goes to the tile it falls in where that has a set, else it wraps.
    pub fn new(atlas: &Atlas, key: SetKey) -> SetLayout {
        SetLayout::gather(atlas, key, false)
    }

    /// As [`SetLayout::new`], with all texels of pixels that several charts claim, for the mean of them.
    pub fn merged(atlas: &Atlas, key: SetKey) -> SetLayout {
        let mut layout = SetLayout::gather(atlas, key, true);
        let SetLayout { shared, cover, .. } = &mut layout;
        shared.retain(|&(pixel, texel)| {
            claim(atlas, texel as usize).is_some_and(|(_, how)| how == cover[pixel as usize])
        });
        shared.sort_unstable();
        layout
    }

    /// Goes over all texels; with `shares`, those that find their pixel taken, or lose it, are listed as they come.
    fn gather(atlas: &Atlas, key: SetKey, shares: bool) -> SetLayout {
        let siblings = match key.udim {
            Some(_) => set_keys(atlas),
            None => Vec::new(),
        };
        let siblings = siblings.iter().filter(|other| other.material == key.material);
        let siblings = siblings.map(|other| other.uv_tile).collect();
        let pixels = atlas.size as usize * atlas.size as usize;
        let mut layout = SetLayout {
            key,
            size: atlas.size,
            source: vec![NONE; pixels],
            cover: vec![Cover::Empty; pixels],
            shared: Vec::new(),
            collisions: 0,
        };
        let [width, height] = atlas.page_size.map(|side| side as usize);
        for tile in &atlas.tiles {
            let (first_x, first_y) = (tile.column as usize * TILE as usize, tile.row as usize * TILE as usize);
            for y in first_y..(first_y + TILE as usize).min(height) {
                let row = (tile.page as usize * height + y) * width;
                for x in first_x..(first_x + TILE as usize).min(width) {
                    let loser = layout.place(atlas, &siblings, row + x, [x as i64, y as i64]);
                    layout.shared.extend(loser.filter(|_| shares));
                }
            }
        }
        layout
    }

    /// All texels that give a pixel its value, the first chart's first.
    pub fn sources(&self, pixel: usize) -> impl Iterator<Item = usize> {
        let start = self.shared.partition_point(|&(other, _)| (other as usize) < pixel);
        let more = self.shared[start..]
            .iter()
            .take_while(move |&&(other, _)| other as usize == pixel);
        let first = self.source.get(pixel).copied().filter(|&texel| texel != NONE);
        first
            .into_iter()
            .chain(more.map(|&(_, texel)| texel))
            .map(|texel| texel as usize)
    }

    /// Gives a texel its pixel, unless one that goes before it has it: that pixel, and which of the two did not get it.
    fn place(
        &mut self,
        atlas: &Atlas,
        siblings: &BTreeSet<[i32; 2]>,
        texel: usize,
        [x, y]: [i64; 2],
    ) -> Option<(u32, u32)> {
        let (chart_index, cover) = claim(atlas, texel)?;
        let chart = atlas.charts.get(chart_index as usize)?;
        if chart.sheet != self.key.material {
            return None;
        }
        let size = i64::from(self.size);
        let plane = [
            x - i64::from(chart.texel_from_uv[0]),
            y - i64::from(chart.texel_from_uv[1]),
        ];
        let fallen_in = plane.map(|at| at.div_euclid(size) as i32);
        let inside = plane.map(|at| at.rem_euclid(size) as usize);
        let several = self.key.udim.is_some();
        let here = if cover == Cover::Ghost {
            // A ring stays on its chart's side of the border.
            fallen_in == chart.uv_tile && (!several || fallen_in == self.key.uv_tile)
        } else if several && siblings.contains(&fallen_in) {
            fallen_in == self.key.uv_tile
        } else {
            // Wraps: in its own tile of several, or onto the one set there is.
            !several || chart.uv_tile == self.key.uv_tile
        };
        if !here {
            return None;
        }
        let pixel = inside[1] * self.size as usize + inside[0];
        let holder = claim(atlas, self.source[pixel] as usize).map(|(chart, _)| chart);
        let before = (self.cover[pixel], holder);
        let taken = before.0 == Cover::Owned && cover == Cover::Owned;
        self.collisions += u64::from(taken);
        let wins = cover > before.0 || (cover == before.0 && before.1.is_some_and(|other| chart_index < other));
        let loser = if wins { self.source[pixel] } else { texel as u32 };
        if wins {
            self.source[pixel] = texel as u32;
            self.cover[pixel] = cover;
        }
        (before.0 != Cover::Empty).then_some((pixel as u32, loser))
    }
}

/// The chart that a texel belongs to, and how.
fn claim(atlas: &Atlas, texel: usize) -> Option<(u32, Cover)> {
    match *atlas.owners.get(texel)? {
        EMPTY => None,
        ghost if ghost & GHOST_BIT != 0 => Some((atlas.ghosts.get((ghost & !GHOST_BIT) as usize)?.chart, Cover::Ghost)),
        triangle => Some((*atlas.triangle_chart.get(triangle as usize)?, Cover::Owned)),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use sabi_surface::atlas::{AtlasReport, Chart, Ghost, TileRef};

    use super::*;

    /// A chart of the test atlas: material, offset, uv tile, and its texels on the page.
    pub(crate) type Piece = (u32, [i32; 2], [i32; 2], std::ops::Range<u32>, std::ops::Range<u32>);

    /// An atlas of rectangles, each of one triangle's number, with rings of one ghost where there is room.
    pub(crate) fn atlas(size: u32, page: u32, pieces: &[Piece]) -> Atlas {
        let mut owners = vec![EMPTY; (page * page) as usize];
        let mut charts = Vec::new();
        let mut ghosts = Vec::new();
        for (index, (material, offset, uv_tile, columns, rows)) in pieces.iter().cloned().enumerate() {
            for y in rows.clone() {
                for x in columns.clone() {
                    owners[(y * page + x) as usize] = index as u32;
                }
            }
            charts.push(Chart {
                page: 0,
                texel_from_uv: offset,
                bounds: [columns.start, rows.start, columns.end, rows.end],
                material,
                sheet: material,
                uv_tile,
                mirrored: false,
                triangles: 1,
                texels: (columns.len() * rows.len()) as u32,
            });
        }
        for (index, (.., columns, rows)) in pieces.iter().enumerate() {
            for y in rows.start.saturating_sub(1)..(rows.end + 1).min(page) {
                for x in columns.start.saturating_sub(1)..(columns.end + 1).min(page) {
                    let owner = &mut owners[(y * page + x) as usize];
                    if *owner == EMPTY {
                        *owner = GHOST_BIT | ghosts.len() as u32;
                        ghosts.push(Ghost {
                            texel: [x, y, 0],
                            chart: index as u32,
                            target_triangle: 0,
                            target_texel: [0.0; 2],
                            target_from_own: [[1.0, 0.0], [0.0, 1.0]],
                        });
                    }
                }
            }
        }
        let side = page / TILE;
        Atlas {
            size,
            page_size: [page; 2],
            pages: 1,
            owners,
            triangle_chart: (0..charts.len() as u32).collect(),
            triangle_texels: vec![[[0.0; 2]; 3]; charts.len()],
            charts,
            ghosts,
            tiles: (0..side * side)
                .map(|i| TileRef {
                    page: 0,
                    row: i / side,
                    column: i % side,
                })
                .collect(),
            leap: vec![1; (page * page) as usize],
            report: AtlasReport::default(),
        }
    }

    fn key(material: u32, uv_tile: [i32; 2], udim: Option<u32>) -> SetKey {
        SetKey {
            material,
            uv_tile,
            udim,
        }
    }

    #[test]
    fn a_chart_in_its_place_is_copied_texel_for_texel() {
        let atlas = atlas(16, 16, &[(0, [0, 0], [0, 0], 2..10, 3..9)]);
        assert_eq!(set_keys(&atlas), [key(0, [0, 0], None)]);
        let layout = &layouts(&atlas)[0];
        for (pixel, &source) in layout.source.iter().enumerate() {
            let expected = if atlas.owners[pixel] == EMPTY {
                NONE
            } else {
                pixel as u32
            };
            assert_eq!(source, expected);
        }
        assert_eq!(layout.cover.iter().filter(|&&cover| cover == Cover::Owned).count(), 48);
        assert_eq!(layout.cover.iter().filter(|&&cover| cover == Cover::Ghost).count(), 32);
    }

    #[test]
    fn a_moved_chart_goes_back_to_its_place_and_loses_the_ring_outside() {
        // The chart's own place is 0..8 × 0..8; on the page it lies at 10..18.
        let atlas = atlas(16, 32, &[(0, [10, 10], [0, 0], 10..18, 10..18)]);
        let layout = &layouts(&atlas)[0];
        assert_eq!(layout.source[0], 10 * 32 + 10);
        assert_eq!(layout.cover[8], Cover::Ghost, "to the right");
        assert_eq!(
            layout.cover[15],
            Cover::Empty,
            "the ring on the left does not wrap around"
        );
        assert_eq!(layout.collisions, 0);
    }

    #[test]
    fn the_lower_chart_wins_where_charts_overlap_and_owned_beats_ghost() {
        // Both at uv texels 0..4: the second is the same place, packed elsewhere, and reaches one texel further.
        let atlas = atlas(
            16,
            32,
            &[(0, [0, 0], [0, 0], 0..4, 0..4), (0, [20, 0], [0, 0], 20..25, 0..4)],
        );
        let layout = &layouts(&atlas)[0];
        assert_eq!(layout.source[0], 0);
        assert_eq!(
            layout.source[4], 24,
            "the second chart's own texel, not the first one's ghost"
        );
        assert_eq!(layout.cover[4], Cover::Owned);
        assert_eq!(layout.cover[5], Cover::Ghost);
        assert_eq!(layout.collisions, 16);
        let merged = SetLayout::merged(&atlas, layout.key);
        assert_eq!(
            merged.sources(0).collect::<Vec<_>>(),
            [0, 20],
            "all owners, and no ghost with them"
        );
        assert_eq!(merged.sources(4).collect::<Vec<_>>(), [24]);
        assert_eq!((&merged.source, layout.shared.len()), (&layout.source, 0));
    }

    #[test]
    fn materials_have_sets_of_their_own() {
        let atlas = atlas(
            16,
            32,
            &[(0, [0, 0], [0, 0], 0..4, 0..4), (2, [20, 0], [0, 0], 20..24, 0..4)],
        );
        assert_eq!(set_keys(&atlas), [key(0, [0, 0], None), key(2, [0, 0], None)]);
        let layouts = layouts(&atlas);
        assert_eq!((layouts[0].source[0], layouts[1].source[0]), (0, 20));
    }

    #[test]
    fn several_tiles_of_a_material_are_udims_and_spilled_texels_go_to_the_tile_they_fall_in() {
        // Second chart: tile (1, −1), that is 1012; its uv texels are 16..20 × −16..−12, and one column spills from tile 0.
        let first = (0, [0, 0], [0, 0], 8..17, 0..4);
        let second = (0, [4, 36], [1, -1], 20..24, 20..24);
        let third = (0, [-16, 0], [2, 0], 24..28, 4..8);
        let atlas = atlas(16, 32, &[first, second, third]);
        let keys = set_keys(&atlas);
        assert_eq!(
            keys.iter().map(|key| key.udim).collect::<Vec<_>>(),
            [Some(1001), Some(1003), Some(1012)]
        );
        let layouts = layouts(&atlas);
        assert_eq!(layouts[2].source[0], 20 * 32 + 20);
        // Tile (1, 0) has no set: the spilled column wraps in its own.
        assert_eq!(layouts[0].source[0], 16);
        assert_eq!(layouts[1].source[4 * 16 + 8], 4 * 32 + 24);
    }

    #[test]
    fn tiles_without_a_udim_number_wrap_onto_one_set() {
        let atlas = atlas(
            16,
            64,
            &[(0, [0, 0], [0, 0], 0..4, 0..4), (0, [40, 0], [-1, 0], 28..32, 0..4)],
        );
        assert_eq!(set_keys(&atlas), [key(0, [-1, 0], None)]);
        let layout = &layouts(&atlas)[0];
        // uv texels −12..−8 wrap to 4..8.
        assert_eq!((layout.source[0], layout.source[4]), (0, 28));
        assert_eq!(udim([0, 1]), None);
        assert_eq!(udim([9, 0]), Some(1010));
        assert_eq!(udim([10, 0]), None);
    }
}
