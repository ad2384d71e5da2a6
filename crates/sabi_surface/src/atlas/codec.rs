//! Encoding of an atlas for the disk cache, in native byte order.

use super::{Atlas, AtlasReport, Chart, EMPTY, GHOST_BIT, Ghost, TILE, TileRef};

/// Maximum number of texels of an atlas. A larger number in a file is refused before anything is allocated.
const TEXELS_LIMIT: u64 = 1 << 29;

const RUN_EMPTY: u64 = 0;
const RUN_GHOSTS: u64 = 1;
const RUN_TRIANGLE: u64 = 2;

/// Encodes an atlas.
pub(super) fn encode(atlas: &Atlas) -> Vec<u8> {
    let mut out = Writer {
        bytes: Vec::with_capacity(atlas.owners.len() / 2 + atlas.triangle_texels.len() * 28),
    };
    out.u32s(&[atlas.size, atlas.page_size[0], atlas.page_size[1], atlas.pages]);
    out.u32s(&[
        atlas.charts.len() as u32,
        atlas.triangle_chart.len() as u32,
        atlas.ghosts.len() as u32,
    ]);
    out.varint(atlas.udim_sheets.len() as u64);
    for sheet in &atlas.udim_sheets {
        out.varint(u64::from(*sheet));
    }
    for chart in &atlas.charts {
        let [dx, dy] = chart.texel_from_uv.map(i32::cast_unsigned);
        let [tile_u, tile_v] = chart.uv_tile.map(i32::cast_unsigned);
        out.u32s(&[chart.uv_chart, chart.page, dx, dy]);
        out.u32s(&chart.bounds);
        let mirrored = u32::from(chart.mirrored);
        let sheet = chart.sheet;
        out.u32s(&[
            chart.material,
            sheet,
            tile_u,
            tile_v,
            mirrored,
            chart.triangles,
            chart.texels,
        ]);
    }
    out.u32s(&atlas.triangle_chart);
    out.bytes
        .extend_from_slice(bytemuck::cast_slice(&atlas.triangle_texels));
    out.owners(&atlas.owners);
    for ghost in &atlas.ghosts {
        out.u32s(&[ghost.chart, ghost.target_triangle]);
        out.u32s(&ghost.target_texel.map(f32::to_bits));
        out.u32s(&ghost.target_from_own[0].map(f32::to_bits));
        out.u32s(&ghost.target_from_own[1].map(f32::to_bits));
        out.u32s(&[ghost.read_triangle]);
        out.u32s(&ghost.read_texel.map(f32::to_bits));
    }
    out.bytes.extend_from_slice(&atlas.leap);
    out.report(&atlas.report);
    out.bytes
}

/// Decodes an atlas; `None` if the bytes are not a valid atlas.
pub(super) fn decode(bytes: &[u8]) -> Option<Atlas> {
    let mut input = ByteReader { bytes };
    let [size, width, height, pages] = input.u32_array()?;
    let [charts, triangles, ghosts] = input.u32_array()?.map(|count| count as usize);
    let texels = (u64::from(width) * u64::from(height)).checked_mul(pages.into())?;
    // The file has at least a byte for each texel, so that a false number cannot allocate more memory than the file has bytes.
    if texels > TEXELS_LIMIT.min(bytes.len() as u64)
        || width == 0
        || !width.is_multiple_of(TILE)
        || !height.is_multiple_of(TILE)
    {
        return None;
    }
    let udims = input.count()?;
    let udim_sheets = input.list(udims, 1, |input| u32::try_from(input.varint()?).ok())?;
    let charts = input.list(charts, 60, ByteReader::chart)?;
    let triangle_chart = input.pods(triangles)?;
    let triangle_texels = input.pods(triangles)?;
    let owners = input.owners(texels as usize)?;
    let mut ghosts = input.list(ghosts, 44, ByteReader::ghost)?;
    place_ghosts(&mut ghosts, &owners, [width, height])?;
    let leap = input.take(texels as usize)?.to_vec();
    let report = input.report()?;
    let page_size = [width, height];
    let tiles = tiles(&owners, page_size);
    input.bytes.is_empty().then_some(Atlas {
        size,
        page_size,
        pages,
        owners,
        udim_sheets: udim_sheets.into_iter().collect(),
        charts,
        triangle_chart,
        triangle_texels,
        ghosts,
        tiles,
        leap,
        report,
    })
}

struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    fn u32s(&mut self, values: &[u32]) {
        self.bytes.extend_from_slice(bytemuck::cast_slice(values));
    }

    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    /// Writes runs of equal owners: length, kind, and for triangles the difference from the previous triangle.
    fn owners(&mut self, owners: &[u32]) {
        let mut triangle = 0i64;
        let ghost = |value: u32| value != EMPTY && value & GHOST_BIT != 0;
        for run in owners.chunk_by(|&a, &b| a == b || (ghost(a) && b == a + 1 && ghost(b))) {
            let (value, length) = (run[0], (run.len() as u64) << 2);
            if value == EMPTY {
                self.varint(length | RUN_EMPTY);
            } else if ghost(value) {
                self.varint(length | RUN_GHOSTS);
            } else {
                self.varint(length | RUN_TRIANGLE);
                let step = i64::from(value) - triangle;
                self.varint(((step << 1) ^ (step >> 63)).cast_unsigned());
                triangle = i64::from(value);
            }
        }
    }

    fn report(&mut self, report: &AtlasReport) {
        self.u32s(&[
            report.coverage.to_bits(),
            report.stacked_charts,
            report.mirrored_charts,
            report.degenerate_uv_triangles,
            report.degenerate_triangles,
            report.nonmanifold_edges,
            report.border_edges,
            report.thin_charts,
            report.moved_charts,
            report.unlinked_ghosts,
            report.pulled_ghosts,
        ]);
        self.bytes.extend_from_slice(&report.overlap_texels.to_ne_bytes());
        self.varint(report.overlapping_charts.len() as u64);
        for &(a, b, texels) in &report.overlapping_charts {
            self.varint(u64::from(a));
            self.varint(u64::from(b));
            self.varint(texels);
        }
        self.varint(report.warnings.len() as u64);
        for warning in &report.warnings {
            self.varint(warning.len() as u64);
            self.bytes.extend_from_slice(warning.as_bytes());
        }
    }
}

struct ByteReader<'a> {
    bytes: &'a [u8],
}

impl<'a> ByteReader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(count)?;
        self.bytes = rest;
        Some(taken)
    }

    fn u32_array<const N: usize>(&mut self) -> Option<[u32; N]> {
        self.pods(N)?.try_into().ok()
    }

    fn pods<T: bytemuck::Pod>(&mut self, count: usize) -> Option<Vec<T>> {
        let taken = self.take(count.checked_mul(size_of::<T>())?)?;
        Some(bytemuck::pod_collect_to_vec(taken))
    }

    /// Reads `count` items of at least `least` bytes each.
    fn list<T>(&mut self, count: usize, least: usize, read: fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        if count.checked_mul(least)? > self.bytes.len() {
            return None;
        }
        (0..count).map(|_| read(self)).collect()
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.take(1)?[0];
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(self.varint()?).ok()
    }

    fn chart(&mut self) -> Option<Chart> {
        let [uv_chart, page, dx, dy] = self.u32_array()?;
        let bounds = self.u32_array()?;
        let [material, sheet, tile_u, tile_v, mirrored, triangles, texels] = self.u32_array()?;
        let texel_from_uv = [dx, dy].map(u32::cast_signed);
        let uv_tile = [tile_u, tile_v].map(u32::cast_signed);
        Some(Chart {
            uv_chart,
            page,
            texel_from_uv,
            bounds,
            material,
            sheet,
            uv_tile,
            mirrored: mirrored != 0,
            triangles,
            texels,
        })
    }

    fn ghost(&mut self) -> Option<Ghost> {
        let [chart, target_triangle] = self.u32_array()?;
        let floats: [u32; 6] = self.u32_array()?;
        let [x, y, ux, uy, vx, vy] = floats.map(f32::from_bits);
        let target_from_own = [[ux, uy], [vx, vy]];
        let [read_triangle] = self.u32_array()?;
        let read_texel: [u32; 2] = self.u32_array()?;
        Some(Ghost {
            texel: [0; 3],
            chart,
            target_triangle,
            target_texel: [x, y],
            target_from_own,
            read_triangle,
            read_texel: read_texel.map(f32::from_bits),
        })
    }

    fn owners(&mut self, texels: usize) -> Option<Vec<u32>> {
        let mut owners = Vec::with_capacity(texels);
        let (mut triangle, mut ghost) = (0i64, GHOST_BIT);
        while owners.len() < texels {
            let token = self.varint()?;
            let end = owners.len().checked_add(usize::try_from(token >> 2).ok()?)?;
            if end > texels {
                return None;
            }
            match token & 3 {
                RUN_EMPTY => owners.resize(end, EMPTY),
                RUN_GHOSTS => {
                    let next = ghost.checked_add((end - owners.len()) as u32)?;
                    owners.extend(ghost..next);
                    ghost = next;
                }
                RUN_TRIANGLE => {
                    let zigzag = self.varint()?;
                    let step = (zigzag >> 1).cast_signed() ^ -(zigzag & 1).cast_signed();
                    triangle = triangle.checked_add(step)?;
                    owners.resize(end, u32::try_from(triangle).ok()?);
                }
                _ => return None,
            }
        }
        Some(owners)
    }

    fn report(&mut self) -> Option<AtlasReport> {
        let [
            coverage,
            stacked_charts,
            mirrored_charts,
            degenerate_uv_triangles,
            degenerate_triangles,
            nonmanifold_edges,
            border_edges,
            thin_charts,
            moved_charts,
            unlinked_ghosts,
            pulled_ghosts,
        ] = self.u32_array()?;
        let overlap_texels = u64::from_ne_bytes(self.take(8)?.try_into().ok()?);
        let pairs = self.count()?;
        let overlapping_charts = self.list(pairs, 3, |input| {
            let (a, b) = (input.varint()?, input.varint()?);
            Some((u32::try_from(a).ok()?, u32::try_from(b).ok()?, input.varint()?))
        })?;
        let warnings = self.count()?;
        let warnings = self.list(warnings, 1, |input| {
            let length = input.count()?;
            String::from_utf8(input.take(length)?.to_vec()).ok()
        })?;
        Some(AtlasReport {
            coverage: f32::from_bits(coverage),
            overlap_texels,
            overlapping_charts,
            stacked_charts,
            mirrored_charts,
            degenerate_uv_triangles,
            degenerate_triangles,
            nonmanifold_edges,
            border_edges,
            thin_charts,
            moved_charts,
            unlinked_ghosts,
            pulled_ghosts,
            warnings,
        })
    }
}

/// Restores the texels of the ghosts, which are stored in the order of their texels.
fn place_ghosts(ghosts: &mut [Ghost], owners: &[u32], [width, height]: [u32; 2]) -> Option<()> {
    let mut found = 0;
    for (row, owners) in owners.chunks_exact(width as usize).enumerate() {
        for (x, &owner) in owners.iter().enumerate() {
            if owner & GHOST_BIT != 0 && owner != EMPTY {
                let row = row as u32;
                ghosts.get_mut(found)?.texel = [x as u32, row % height, row / height];
                found += 1;
            }
        }
    }
    (found == ghosts.len()).then_some(())
}

/// Tiles with at least one texel in use.
fn tiles(owners: &[u32], [width, height]: [u32; 2]) -> Vec<TileRef> {
    let (wide, tile) = (width as usize, TILE as usize);
    let mut tiles = Vec::new();
    for (tile_row, rows) in owners.chunks_exact(wide * tile).enumerate() {
        let page = tile_row / (height / TILE) as usize;
        let row = tile_row % (height / TILE) as usize;
        for column in 0..wide / tile {
            let used = rows
                .chunks_exact(wide)
                .any(|row| row[column * tile..][..tile].iter().any(|&o| o != EMPTY));
            if used {
                tiles.push(TileRef {
                    page: page as u32,
                    row: row as u32,
                    column: column as u32,
                });
            }
        }
    }
    tiles
}
