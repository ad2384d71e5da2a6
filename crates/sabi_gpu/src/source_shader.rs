//! Kernels of sources.

use sabi_nodes::link::{Format, Given};
use strum::VariantArray;

use crate::bindings::{storage_entry, table_entry, texture_entry, uniform_entry};

/// Number of textures of a kernel of [`SourceShader::Textures`].
pub const TEXTURES: usize = 4;
/// Names of the storages of the textures in the shaders.
const STORAGES: [&str; TEXTURES] = ["STORAGE_0", "STORAGE_1", "STORAGE_2", "STORAGE_3"];

/// Storage of the pixels of a picture, see `shaders/source/picture.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, VariantArray)]
pub enum PictureStorage {
    /// Four codes of 8 bits.
    Codes8,
    /// Four codes of 16 bits.
    Codes16,
    /// Four half floats.
    Halves,
    /// Four floats.
    Floats,
    /// There is no picture.
    None,
}

impl PictureStorage {
    /// All of them.
    pub(crate) const ALL: &'static [PictureStorage] = PictureStorage::VARIANTS;

    /// Number in the shader.
    pub(crate) fn number(self) -> u32 {
        self as u32
    }
}

/// Kinds of things that have a row in a table of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PartRows {
    /// Parts.
    Part,
    /// Materials.
    Material,
    /// Charts.
    Chart,
    /// Connected pieces.
    Piece,
    /// The whole model: there is one row.
    Whole,
}

/// Projection of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProjectionWay {
    /// By texture coordinates.
    Uv,
    /// From three sides.
    Triplanar,
    /// From one side.
    Decal,
}

/// Kernel of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ImageShader {
    /// Storage of the picture.
    pub storage: PictureStorage,
    /// True for a normal map whose slope is shown.
    pub shows_slope: bool,
    /// Its projection.
    pub way: ProjectionWay,
    /// True if the picture is read at places from an input instead of those of the surface.
    pub reads_place: bool,
    /// True for a file with several pictures, of which one is used.
    pub has_cells: bool,
    /// True if random patches of it are tiled.
    pub is_random: bool,
}

/// Kernel of a source. Properties that are the same for all texels and decide which data is read are part of the kernel,
/// since software adapters run both sides of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SourceShader {
    /// Values of parts, or positions in their boxes. Has one table.
    Parts {
        /// Kind of things that have a row in it.
        of: PartRows,
        /// True if each has three rows: the sides of its box, with the middle of the box in the fourth column.
        has_boxes: bool,
    },
    /// Colors of vertices, or only their fourth component. Tables: the corners of triangles, and the colors.
    VertexColor {
        /// True for only the fourth component.
        is_alpha: bool,
    },
    /// A picture. One table: its pixels. Two inputs: the place to read at, and the selection of one of several pictures.
    Image(ImageShader),
    /// Channels of textures of a material. For each texture two tables: its pixels, and its coordinates.
    Textures([PictureStorage; TEXTURES]),
    /// Directions from a texture of a material. Two tables: its pixels, and its coordinates.
    Directions {
        /// Storage of the texture.
        storage: PictureStorage,
        /// True for the slope of a normal map, false for the direction of fine scratches.
        shows_slope: bool,
    },
}

impl SourceShader {
    /// Returns a set of kernels that uses each part of each file at least once.
    pub(crate) fn kinds() -> Vec<SourceShader> {
        let rows = [
            PartRows::Part,
            PartRows::Material,
            PartRows::Chart,
            PartRows::Piece,
            PartRows::Whole,
        ];
        let boxes = |of| [false, true].map(|has_boxes| SourceShader::Parts { of, has_boxes });
        let mut kinds: Vec<SourceShader> = rows.into_iter().flat_map(boxes).collect();
        for is in [false, true] {
            kinds.push(SourceShader::VertexColor { is_alpha: is });
            for way in [ProjectionWay::Uv, ProjectionWay::Triplanar, ProjectionWay::Decal] {
                kinds.push(SourceShader::Image(ImageShader {
                    storage: PictureStorage::Floats,
                    shows_slope: is,
                    way,
                    reads_place: is,
                    has_cells: is,
                    is_random: !is,
                }));
            }
            kinds.extend(PictureStorage::ALL.iter().map(|&storage| SourceShader::Directions {
                storage,
                shows_slope: is,
            }));
        }
        kinds.extend(
            PictureStorage::ALL
                .iter()
                .map(|&storage| SourceShader::Textures([storage; TEXTURES])),
        );
        kinds
    }

    /// Name in messages and debuggers.
    pub(crate) fn label(self) -> &'static str {
        match self {
            SourceShader::Parts { .. } => "parts",
            SourceShader::VertexColor { .. } => "vertex colors",
            SourceShader::Image(_) => "an image",
            SourceShader::Textures(_) => "textures of a material",
            SourceShader::Directions { .. } => "directions of a material",
        }
    }

    /// File to link.
    pub(crate) fn file(self) -> &'static str {
        match self {
            SourceShader::Parts { .. } => "source/parts",
            SourceShader::VertexColor { .. } => "source/vertex_color",
            SourceShader::Image(_) => "source/image",
            SourceShader::Textures(_) => "source/textures",
            SourceShader::Directions { .. } => "source/directions",
        }
    }

    /// Returns the constants that the file receives.
    pub(crate) fn given(self, format: Format) -> Vec<Given> {
        let mut given = vec![Given::flag("IS_HALF", format == Format::Rgba16Float)];
        given.extend(match self {
            SourceShader::Parts { of, has_boxes } => {
                vec![Given::number("BY", of as u32), Given::flag("HAS_BOXES", has_boxes)]
            }
            SourceShader::VertexColor { is_alpha } => vec![Given::flag("IS_ALPHA", is_alpha)],
            SourceShader::Image(image) => vec![
                Given::number(STORAGES[0], image.storage.number()),
                Given::flag("SHOWS_SLOPE", image.shows_slope),
                Given::number("WAY", image.way as u32),
                Given::flag("READS_PLACE", image.reads_place),
                Given::flag("HAS_CELLS", image.has_cells),
                Given::flag("IS_RANDOM", image.is_random),
            ],
            SourceShader::Textures(storages) => {
                let numbers = STORAGES.into_iter().zip(storages);
                numbers
                    .map(|(name, storage)| Given::number(name, storage.number()))
                    .collect()
            }
            SourceShader::Directions { storage, shows_slope } => vec![
                Given::number(STORAGES[0], storage.number()),
                Given::flag("SHOWS_SLOPE", shows_slope),
            ],
        });
        given
    }

    /// Number of tables.
    pub(crate) fn tables(self) -> usize {
        match self {
            SourceShader::Parts { .. } | SourceShader::Image(_) => 1,
            SourceShader::VertexColor { .. } | SourceShader::Directions { .. } => 2,
            SourceShader::Textures(_) => 2 * TEXTURES,
        }
    }

    /// Number of inputs.
    pub(crate) fn inputs(self) -> usize {
        match self {
            SourceShader::Image(_) => 2,
            _ => 0,
        }
    }

    /// Returns the layout of the bind group: constants if there are any, tables, inputs, and the field that is written.
    pub(crate) fn entries(self, format: Format) -> Vec<wgpu::BindGroupLayoutEntry> {
        let has_constants = !matches!(self, SourceShader::Parts { .. } | SourceShader::VertexColor { .. });
        let first = u32::from(has_constants);
        let inputs = first + self.tables() as u32;
        let end = inputs + self.inputs() as u32;
        let mut entries: Vec<_> = has_constants.then(|| uniform_entry(0)).into_iter().collect();
        entries.extend((first..inputs).map(table_entry));
        entries.extend((inputs..end).map(texture_entry));
        entries.push(storage_entry(end, format));
        entries
    }
}
