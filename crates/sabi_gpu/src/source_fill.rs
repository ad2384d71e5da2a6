//! Requests of a run to its caller: the results of source nodes, and the scene for rays.

use sabi_nodes::link::Plane;
use sabi_plan::SourceStep;

use crate::error::GpuError;
use crate::rays::RayScene;
use crate::readback::PlaneData;
use crate::source_canvas::SourceCanvas;
use crate::tile_set::TileSet;

/// Provider of the results of source nodes, and of the scene for rays.
pub trait SourceFill {
    /// Draws one plane of the result `output` of a step on the device. Returns false if the provider computes it on the
    /// processor instead; see [`SourceFill::plane`].
    ///
    /// # Errors
    /// The provider cannot give the result ([`GpuError::Node`]), the run is canceled, or the device refuses.
    fn draw(
        &mut self,
        _canvas: &SourceCanvas<'_>,
        _step: &SourceStep,
        _output: &str,
        _plane: Plane,
    ) -> Result<bool, GpuError> {
        Ok(false)
    }

    /// Returns the texels of one plane of the result `output` of a step, including ghosts, in the plane's storage format,
    /// page by page and row by row without padding. Planes are requested one after the other, and each is dropped before
    /// the next. `inputs` holds the texels of the step's connected inputs, in the order in which the kind declares them. If
    /// tiles are given, texels outside of them may have any value.
    fn plane(
        &mut self,
        step: &SourceStep,
        output: &str,
        plane: Plane,
        inputs: &[Option<PlaneData>],
        tiles: Option<&TileSet>,
    ) -> Result<Vec<u8>, String>;

    /// Returns the tiles in which the results of a step differ from those of the same step of an earlier plan, as far as
    /// that follows from their parameters; `None` if it is not known.
    fn changed_tiles(&mut self, _before: &SourceStep, _now: &SourceStep) -> Option<TileSet> {
        None
    }

    /// Returns the texels of some tiles of a plane, in the format of [`SourceFill::plane`], tile by tile. Called only if
    /// [`SourceFill::changed_tiles`] returned tiles for the step.
    fn plane_tiles(
        &mut self,
        step: &SourceStep,
        output: &str,
        _plane: Plane,
        _inputs: &[Option<PlaneData>],
        _tiles: &TileSet,
    ) -> Result<Vec<u8>, String> {
        Err(format!(
            "node '{}' gives no tiles of '{output}', which is a defect of Sabi",
            step.id
        ))
    }

    /// Returns the scene into which rays are cast.
    fn scene(&mut self) -> Result<RayScene<'_>, String>;

    /// Returns true if results of ray steps are cached on disk.
    fn caches_rays(&self) -> bool {
        false
    }

    /// Cached results of a key.
    fn cached_rays(&mut self, _key: &[u8; 32]) -> Option<Vec<u8>> {
        None
    }

    /// Caches results under a key.
    fn cache_rays(&mut self, _key: &[u8; 32], _results: &[u8]) {}

    /// Returns true if results that take long to compute are kept for later runs.
    fn keeps_results(&self) -> bool {
        false
    }

    /// Returns true if there is a kept result with this key. It may be damaged.
    fn has_result(&self, _key: &[u8; 32]) -> bool {
        false
    }

    /// Returns the kept result with this key.
    fn kept_result(&mut self, _key: &[u8; 32]) -> Option<Vec<u8>> {
        None
    }

    /// Keeps a result under a key.
    fn keep_result(&mut self, _key: &[u8; 32], _result: &[u8]) {}
}
