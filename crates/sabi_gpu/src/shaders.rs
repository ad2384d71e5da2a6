//! Sabi's own kernels: the files from which each is linked, and the values that it receives.

use sabi_nodes::link::{Access, Format, Given, LinkedModule, ModuleSpec};

use crate::error::GpuError;
use crate::source_shader::SourceShader;

/// Bind group of the surface in every kernel, see `lib/atlas.wgsl`.
const SURFACE_GROUP: Given = Given::group("SURFACE_GROUP", 0);

/// Formats of the planes of the atlas.
const FORMATS: [Format; 3] = [Format::R32Float, Format::Rgba16Float, Format::Rgba32Float];

/// Kernel that does not consist of nodes, with the format of the texture that it writes if there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum FixedShader {
    Anisotropy,
    Cast,
    CoupledInPlace,
    Extent,
    FindJumps,
    FromPoints(Format),
    GatherBorders,
    GatherCoupled(Format),
    GatherPlain(Format),
    Normal,
    PlainInPlace,
    Prolong(Format),
    RefineGhosts,
    Restrict(Format),
    ScatterFilled(Format),
    ScatterGhosts(Format),
    SettleCoupled,
    Share(Format),
    Source(SourceShader, Format),
    Stencil,
    SurveyCount,
    SurveyRange,
    SurveySum,
    ToPoints(Format),
}

impl FixedShader {
    /// All kernels in all formats.
    pub(crate) fn all() -> Vec<FixedShader> {
        use FixedShader::*;
        let with_format = [
            FromPoints,
            GatherCoupled,
            GatherPlain,
            Prolong,
            Restrict,
            ScatterFilled,
            ScatterGhosts,
            Share,
            ToPoints,
        ];
        let mut all = vec![
            Anisotropy,
            Cast,
            CoupledInPlace,
            Extent,
            FindJumps,
            GatherBorders,
            Normal,
            PlainInPlace,
            RefineGhosts,
            SettleCoupled,
            Stencil,
            SurveyCount,
            SurveyRange,
            SurveySum,
        ];
        all.extend(with_format.iter().flat_map(|make| FORMATS.map(make)));
        let sources = SourceShader::kinds().into_iter();
        all.extend(sources.flat_map(|shader| FORMATS.map(|format| Source(shader, format))));
        all
    }

    /// Name in messages and debuggers.
    pub(crate) fn label(self) -> &'static str {
        match self {
            FixedShader::Anisotropy => "anisotropy",
            FixedShader::Cast => "cast",
            FixedShader::CoupledInPlace => "coupled ghosts in place",
            FixedShader::Extent => "extent",
            FixedShader::FindJumps => "find jumps",
            FixedShader::FromPoints(_) => "from points",
            FixedShader::GatherBorders => "gather borders",
            FixedShader::GatherCoupled(_) => "gather coupled",
            FixedShader::GatherPlain(_) => "gather plain",
            FixedShader::Normal => "normal",
            FixedShader::PlainInPlace => "plain ghosts in place",
            FixedShader::Prolong(_) => "prolong",
            FixedShader::RefineGhosts => "refine ghosts",
            FixedShader::Restrict(_) => "restrict",
            FixedShader::ScatterFilled(_) => "scatter filled",
            FixedShader::ScatterGhosts(_) => "scatter ghosts",
            FixedShader::SettleCoupled => "settle coupled",
            FixedShader::Share(_) => "share",
            FixedShader::Source(shader, _) => shader.label(),
            FixedShader::Stencil => "stencil",
            FixedShader::SurveyCount => "survey count",
            FixedShader::SurveyRange => "survey range",
            FixedShader::SurveySum => "survey sum",
            FixedShader::ToPoints(_) => "to points",
        }
    }

    /// Returns the files to link, and the values that they receive.
    pub(crate) fn spec(self) -> ModuleSpec {
        let writes = |format| Some(Given::storage("StoredField", format, Access::Write));
        let updates = Some(Given::storage("StoredField", Format::R32Float, Access::ReadWrite));
        let (files, field) = match self {
            FixedShader::Anisotropy => (vec!["surface/anisotropy"], None),
            FixedShader::Cast => (vec!["surface/cast"], None),
            FixedShader::CoupledInPlace => (vec!["surface/fill_coupled", "surface/access_in_place"], updates),
            FixedShader::Extent => (vec!["surface/extent"], None),
            FixedShader::FindJumps => (vec!["surface/find_jumps"], None),
            FixedShader::FromPoints(format) => (vec!["surface/from_points"], writes(format)),
            FixedShader::GatherBorders => (vec!["surface/gather_borders"], None),
            FixedShader::GatherCoupled(format) => (gathering("surface/fill_coupled", format), None),
            FixedShader::GatherPlain(format) => (gathering("surface/fill_plain", format), None),
            FixedShader::Normal => (vec!["surface/normal"], None),
            FixedShader::PlainInPlace => (vec!["surface/fill_plain", "surface/access_in_place"], updates),
            FixedShader::Prolong(format) => (vec!["surface/prolong"], writes(format)),
            FixedShader::RefineGhosts => (vec!["surface/refine_ghosts"], None),
            FixedShader::Restrict(format) => (vec!["surface/restrict"], writes(format)),
            FixedShader::ScatterFilled(format) => (vec!["surface/scatter_filled"], writes(format)),
            FixedShader::ScatterGhosts(format) => (vec!["surface/scatter_ghosts"], writes(format)),
            FixedShader::SettleCoupled => (vec!["surface/fill_coupled", "surface/access_settle"], updates),
            FixedShader::Share(format) => (vec!["surface/share"], writes(format)),
            FixedShader::Source(shader, format) => (vec![shader.file()], writes(format)),
            FixedShader::Stencil => (vec!["surface/stencil"], None),
            FixedShader::SurveyCount => (vec!["surface/survey_count"], None),
            FixedShader::SurveyRange => (vec!["surface/survey_range"], None),
            FixedShader::SurveySum => (vec!["surface/survey_sum"], None),
            FixedShader::ToPoints(format) => (vec!["surface/to_points"], writes(format)),
        };
        let constants = match self {
            FixedShader::Source(shader, format) => shader.given(format),
            _ => Vec::new(),
        };
        ModuleSpec {
            label: self.label(),
            files,
            given: std::iter::once(SURFACE_GROUP).chain(field).chain(constants).collect(),
        }
    }
}

/// Files of a kernel that gathers values of a format in a buffer.
fn gathering(fill: &'static str, format: Format) -> Vec<&'static str> {
    let keep = match format {
        Format::R32Float => "surface/keep_number",
        Format::Rgba16Float | Format::Rgba32Float => "surface/keep_color",
    };
    vec![fill, "surface/access_gather", keep]
}

/// A module of Sabi's own files.
pub(crate) fn linked(spec: &ModuleSpec) -> Result<LinkedModule, GpuError> {
    spec.link()
        .map_err(|fault| GpuError::Defect(format!("a shader cannot be linked: {fault}")))
}

/// Returns the error of a module that was refused. If the mistake is in a source file, it names file and line.
pub(crate) fn in_source(error: GpuError, linked: &LinkedModule) -> GpuError {
    match error {
        GpuError::Driver(reason) => GpuError::Driver(match linked.check() {
            Ok(()) => reason,
            Err(fault) => fault.to_string(),
        }),
        other => other,
    }
}

/// Returns everything from which Sabi's own kernels are linked, for tests.
pub fn fixed_modules() -> Vec<ModuleSpec> {
    FixedShader::all().into_iter().map(FixedShader::spec).collect()
}
