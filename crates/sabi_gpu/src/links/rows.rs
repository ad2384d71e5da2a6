//! Rows of links in the layout that kernels read.

use sabi_nodes::wgsl_struct;
use sabi_surface::atlas::{Atlas, EMPTY, Ghost, Orphan, Owner};

/// Rows of four numbers for each ghost in the table of all links.
pub(crate) const GHOST_ROWS: usize = 4;

wgsl_struct! {
    "atlas" GhostLink:
    /// First three rows of a ghost: the point beyond the seam that continues its chart.
    pub(crate) struct GhostLinkRow {
        target_texel: [f32; 2],
        triangle: u32,
        texel: u32,
        page: u32,
        target_page: u32,
        chart: u32,
        pad: u32,
        target_from_own: [f32; 4],
    }
}

wgsl_struct! {
    "atlas" GhostRead:
    /// Last row of a ghost: the place from which it takes stored values.
    pub(crate) struct GhostReadRow {
        texel: [f32; 2],
        page: u32,
        anchor: u32,
    }
}

/// Rows of a ghost.
pub(super) struct LinkRow {
    link: GhostLinkRow,
    read: GhostReadRow,
}

impl LinkRow {
    pub(super) fn of_ghost(atlas: &Atlas, ghost: &Ghost) -> LinkRow {
        let [[a, b], [c, d]] = ghost.target_from_own;
        let page = |triangle: u32| atlas.charts[atlas.triangle_chart[triangle as usize] as usize].page;
        LinkRow {
            link: GhostLinkRow {
                target_texel: ghost.target_texel,
                triangle: ghost.target_triangle,
                texel: ghost.texel[0] | (ghost.texel[1] << 16),
                page: ghost.texel[2],
                target_page: page(ghost.target_triangle),
                chart: ghost.chart,
                pad: 0,
                target_from_own: [a, b, c, d],
            },
            read: GhostReadRow {
                texel: ghost.read_texel,
                page: page(ghost.read_triangle),
                anchor: anchor(atlas, ghost),
            },
        }
    }

    /// Returns the rows in the form in which they are uploaded.
    pub(super) fn rows(&self) -> [[u32; 4]; GHOST_ROWS] {
        let [a, b, c]: [[u32; 4]; 3] = bytemuck::cast(self.link);
        [a, b, c, bytemuck::cast(self.read)]
    }
}

/// Packs a step of at most two texels in each direction, as `fill_coupled.wgsl` reads it.
fn packed_step([x, y]: [i32; 2]) -> u32 {
    (x + 2) as u32 | ((y + 2) as u32) << 3
}

/// Step from a ghost to the nearest owned texel of its chart.
fn anchor(atlas: &Atlas, ghost: &Ghost) -> u32 {
    let steps = (0..25).map(|index| [index % 5 - 2, index / 5 - 2]);
    let is_owned = |[x, y]: &[i32; 2]| {
        let [column, row, page] = ghost.texel;
        let place = column.checked_add_signed(*x).zip(row.checked_add_signed(*y));
        place.is_some_and(|(column, row)| match atlas.owner(column, row, page) {
            Owner::Triangle(triangle) => atlas.triangle_chart[triangle as usize] == ghost.chart,
            Owner::Ghost(_) | Owner::Empty => false,
        })
    };
    let nearest = steps.filter(is_owned).min_by_key(|[x, y]| x * x + y * y);
    // The chart is too thin to own a texel near its ghost, so the ghost keeps its own value.
    packed_step(nearest.unwrap_or([0, 0]))
}

/// Packs the rows from which `fill_link` in `shaders/lib/atlas.wgsl` and `fill_coupled.wgsl` fill a ghost. First row:
/// the lowest of the four texels around its point, the distance of the point from that texel in 65536ths, the ghost's
/// own texel, both pages. Second row: bits of those of the four that are not empty, bits of the owned ones, and the
/// step to the owned texel whose value the ghost takes if it can use none of the four.
pub(super) fn fill_rows(atlas: &Atlas, row: &LinkRow) -> [[u32; 4]; 2] {
    let [width, height] = atlas.page_size;
    let place = [(row.read.texel[0], width), (row.read.texel[1], height)]
        .map(|(at, side)| (f64::from(at) - 0.5).clamp(0.0, f64::from(side - 2)));
    let [column, line] = place.map(|at| at as u32);
    let [along, down] = place.map(|at| ((at - at.floor()) * 65536.0) as u32 & 0xffff);
    let bits = |is_counted: &dyn Fn(Owner) -> bool| {
        let taps = [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().enumerate();
        let counted = taps.filter(|(_, (x, y))| is_counted(atlas.owner(column + x, line + y, row.read.page)));
        counted.fold(0, |bits, (tap, _)| bits | 1 << tap)
    };
    let present = bits(&|owner| !matches!(owner, Owner::Empty));
    let owned = bits(&|owner| matches!(owner, Owner::Triangle(_)));
    [
        [
            column | line << 16,
            along | down << 16,
            row.link.texel,
            row.read.page | row.link.page << 16,
        ],
        [present, owned, row.read.anchor, 0],
    ]
}

/// Fill rows of a texel that takes the value of one owned texel.
pub(super) fn orphan_rows(orphan: &Orphan) -> [[u32; 4]; 2] {
    let packed = |[x, y, _]: [u32; 3]| x | y << 16;
    let pages = orphan.from[2] | orphan.texel[2] << 16;
    [
        [packed(orphan.from), 0, packed(orphan.texel), pages],
        [1, 1, packed_step([0, 0]), 0],
    ]
}

/// Indices, among the coupled ghosts, of the four texels around a ghost's point, [`EMPTY`] for other texels: the third
/// row of a coupled ghost, as `access_settle.wgsl` reads it.
pub(super) fn coupled_slots(
    atlas: &Atlas,
    [[corner, _, _, pages], _]: &[[u32; 4]; 2],
    slots: &[Option<u32>],
) -> [u32; 4] {
    [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
        match atlas.owner((corner & 0xffff) + x, (corner >> 16) + y, pages & 0xffff) {
            // Plain ghosts have no slot, since they are filled earlier.
            Owner::Ghost(ghost) => slots[ghost as usize].unwrap_or(EMPTY),
            Owner::Triangle(_) | Owner::Empty => EMPTY,
        }
    })
}
