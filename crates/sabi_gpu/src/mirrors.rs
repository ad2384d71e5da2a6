//! Everything in this crate that is also declared in WGSL files.

use sabi_nodes::link::{Mirror, MirrorsWgsl};
use sabi_surface::atlas::{EMPTY, GHOST_BIT, RINGS, TILE};

use crate::borders::{self, BorderConstants};
use crate::extents::ExtentConstants;
use crate::leaps::LEAP_BITS;
use crate::levels::Scale;
use crate::links::{self, FillConstants, GHOST_ROWS, GhostLinkRow, GhostReadRow};
use crate::normals::NormalConstants;
use crate::pass_constants::PassConstants;
use crate::rays::device::{self, CastConstants};
use crate::rays::hierarchy::MAX_DEPTH;
use crate::rays::{HitRow, RayRow};
use crate::shares::{self, ShareConstants};
use crate::source_constants::{
    COORDINATE_ROWS, COORDINATE_ROWS_WITH_TANGENTS, COPY_ROWS, CORNER_ROWS, DirectionConstants, ImageConstants,
    NO_CHANNEL, PictureConstants, ProjectionConstants, TextureConstants, TexturesConstants,
};
use crate::source_shader::{PartRows, PictureStorage, ProjectionWay};
use crate::survey::{BINS, SurveyConstants};
use crate::tables::{FRAME_ROWS, GEOMETRY_ROWS, PIECE_ROWS};
use crate::uploads::TABLE_BITS;

/// Returns the structs, constants and workgroup sizes that are declared here and in WGSL. A test compares them with all linked modules.
pub fn mirrors() -> Vec<Mirror> {
    let mut mirrors = vec![
        BorderConstants::mirror(),
        ExtentConstants::mirror(),
        CastConstants::mirror(),
        FillConstants::mirror(),
        GhostLinkRow::mirror(),
        GhostReadRow::mirror(),
        HitRow::mirror(),
        PassConstants::mirror(),
        RayRow::mirror(),
        NormalConstants::mirror(),
        Scale::mirror(),
        ShareConstants::mirror(),
        SurveyConstants::mirror(),
    ];
    let rows = |rust, wgsl, rows: usize| Mirror::constant(rust, "atlas", wgsl, [rows as u32]);
    mirrors.extend([
        rows("GEOMETRY_ROWS", "GEOMETRY_ROWS", GEOMETRY_ROWS),
        rows("FRAME_ROWS", "FRAME_ROWS", FRAME_ROWS),
        rows("PIECE_ROWS", "PIECE_ROWS", PIECE_ROWS),
        rows("GHOST_ROWS", "GHOST_ROWS", GHOST_ROWS),
        Mirror::constant("EMPTY", "atlas", "EMPTY", [EMPTY]),
        Mirror::constant("GHOST_BIT", "atlas", "GHOST_BIT", [GHOST_BIT]),
        Mirror::constant("TABLE_BITS", "atlas", "TABLE_BITS", [TABLE_BITS]),
        Mirror::constant("LEAP_BITS", "atlas", "LEAP_BITS", [LEAP_BITS]),
        Mirror::constant("TILE", "surface/place", "TILE", [TILE]),
        Mirror::constant("RINGS", "surface/borders", "REACH", [RINGS]),
        Mirror::constant("STEP_BIT", "surface/borders", "STEP_BIT", [borders::STEP_BIT]),
        Mirror::constant("BINS", "survey", "SURVEY_STEPS", [BINS]),
        Mirror::constant("MAX_DEPTH", "surface/cast", "STACK", [MAX_DEPTH as u32]),
        Mirror::workgroup("the caster's GROUP", "surface/cast", "main", [device::GROUP, 1, 1]),
        Mirror::workgroup("the shares' GROUP", "surface/share", "main", [shares::GROUP, 1, 1]),
        Mirror::workgroup("a row of a tile", "surface/extent", "main", [TILE, 1, 1]),
    ]);
    mirrors.extend(of_sources());
    let over_links = [
        "surface/fill_plain",
        "surface/fill_coupled",
        "surface/refine_ghosts",
        "surface/scatter_filled",
        "surface/scatter_ghosts",
    ];
    let over_borders = ["surface/find_jumps", "surface/gather_borders"];
    mirrors
        .extend(over_borders.map(|file| Mirror::workgroup("the borders' GROUP", file, "main", [borders::GROUP, 1, 1])));
    mirrors.extend(over_links.map(|file| Mirror::workgroup("the links' GROUP", file, "main", [links::GROUP, 1, 1])));
    let over_tiles = [
        "surface/normal",
        "surface/prolong",
        "surface/restrict",
        "surface/stencil",
        "surface/survey_count",
        "surface/survey_range",
    ];
    mirrors.extend(over_tiles.map(|file| Mirror::workgroup("a tile", file, "main", [TILE, TILE, 1])));
    mirrors
}

/// Structs and constants of kernels of sources.
fn of_sources() -> Vec<Mirror> {
    let mut mirrors = vec![
        DirectionConstants::mirror(),
        ImageConstants::mirror(),
        PictureConstants::mirror(),
        ProjectionConstants::mirror(),
        TextureConstants::mirror(),
        TexturesConstants::mirror(),
    ];
    let constants = [
        ("COPY_ROWS", "source/picture", COPY_ROWS),
        ("COORDINATE_ROWS", "source/coordinates", COORDINATE_ROWS),
        (
            "COORDINATE_ROWS_WITH_TANGENTS",
            "source/coordinates",
            COORDINATE_ROWS_WITH_TANGENTS,
        ),
        ("CORNER_ROWS", "source/vertex_color", CORNER_ROWS),
        ("NO_CHANNEL", "source/textures", NO_CHANNEL),
        ("CODES_8", "source/picture", PictureStorage::Codes8.number()),
        ("HALVES", "source/picture", PictureStorage::Halves.number()),
        ("CODES_16", "source/picture", PictureStorage::Codes16.number()),
        ("FLOATS", "source/picture", PictureStorage::Floats.number()),
        ("BY_PART", "source/parts", PartRows::Part as u32),
        ("BY_MATERIAL", "source/parts", PartRows::Material as u32),
        ("BY_CHART", "source/parts", PartRows::Chart as u32),
        ("BY_PIECE", "source/parts", PartRows::Piece as u32),
        ("BY_UV", "source/projection", ProjectionWay::Uv as u32),
        ("TRIPLANAR", "source/projection", ProjectionWay::Triplanar as u32),
        ("NO_PICTURE", "source/picture", PictureStorage::None.number()),
    ];
    mirrors.extend(constants.map(|(name, file, value)| Mirror::constant(name, file, name, [value])));
    mirrors
}
