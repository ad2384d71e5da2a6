//! Environments that light the model: built-in ones by name, or a picture.

use std::path::{Path, PathBuf};

use sabi_files::{Cache, CacheKind, Unread, read_plain};
use sabi_graph::nearest;
use sabi_image::Pixels;
use sabi_view::{Environment, Panorama};

use crate::error::{EngineError, ErrorKind};
use sabi_gpu::Gpu;

/// Name of the environment that is shown by default.
pub(crate) const DEFAULT_ENVIRONMENT: &str = "studio";

/// Built-in environments, the default first. `cargo xtask assets` writes them.
const BUILT_IN: [(&str, &[u8]); 5] = [
    (
        DEFAULT_ENVIRONMENT,
        include_bytes!("../../../../assets/environments/studio.hdr"),
    ),
    (
        "overcast",
        include_bytes!("../../../../assets/environments/overcast.hdr"),
    ),
    ("low_sun", include_bytes!("../../../../assets/environments/low_sun.hdr")),
    (
        "interior",
        include_bytes!("../../../../assets/environments/interior.hdr"),
    ),
    (
        "softboxes",
        include_bytes!("../../../../assets/environments/softboxes.hdr"),
    ),
];

/// Maximum size of environment files. Larger ones are not read.
const SIZE_LIMIT_BYTES: u64 = 1 << 30;

/// Cache of environments of 1 or 4 MiB each. The version changes whenever the same panorama is prefiltered differently.
const KIND: CacheKind = CacheKind {
    prefix: "light",
    version: 2,
    limit_bytes: 64 << 20,
};

/// Lists the names of the built-in environments, the default first.
pub fn built_in_environments() -> impl Iterator<Item = &'static str> {
    BUILT_IN.iter().map(|(name, _)| *name)
}

/// Loads an environment and prefilters it on the device. `choice` is the name of a built-in environment or the path of a
/// picture; see [`read_panorama`]. Prefiltered light is stored in the cache folder, if there is one. Also returns warnings.
pub fn load_environment(
    gpu: &Gpu,
    choice: &str,
    cache_dir: Option<&Path>,
) -> Result<(Environment, Vec<String>), EngineError> {
    let _span = tracing::debug_span!("load environment", choice).entered();
    let (panorama, mut remarks) = read_panorama(choice)?;
    let (environment, remark) = environment_of(gpu, &panorama, cache_dir)?;
    remarks.extend(remark);
    Ok((environment, remarks))
}

/// Prefilters a panorama on the device. Also returns a warning if the result could not be stored in the cache folder.
pub(crate) fn environment_of(
    gpu: &Gpu,
    panorama: &Panorama,
    cache_dir: Option<&Path>,
) -> Result<(Environment, Option<String>), EngineError> {
    let Some(cache) = cache_dir.map(|folder| Cache::new(folder.join("light"), KIND)) else {
        return Ok((Environment::new(gpu, panorama)?, None));
    };
    let key = key_of(gpu, panorama);
    if let Some(kept) = cache.read(&key)
        && let Ok(environment) = Environment::from_prefiltered(gpu, panorama, &kept)
    {
        return Ok((environment, None));
    }
    let environment = Environment::new(gpu, panorama)?;
    let mut remark = None;
    if let Err(error) = cache.write(&key, &environment.prefiltered_bytes(gpu)?) {
        remark = Some(format!(
            "the prefiltered environment could not be stored in {} ({}), so it will be computed again; free some space \
             there or choose another cache folder",
            cache.folder().display(),
            error.reason()
        ));
    }
    Ok((environment, remark))
}

/// Returns the cache key of a prefiltered environment: a hash of the light and of the adapter, whose rounding affects
/// the result.
fn key_of(gpu: &Gpu, panorama: &Panorama) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    let summary = gpu.summary();
    for text in [&summary.name, &summary.driver, &summary.backend] {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    hasher.update(&panorama.width().to_le_bytes());
    hasher.update(&panorama.height().to_le_bytes());
    for row in panorama.rgb().chunks(panorama.width() as usize) {
        let bytes: Vec<u8> = row
            .as_flattened()
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        hasher.update(&bytes);
    }
    *hasher.finalize().as_bytes()
}

/// Reads a built-in environment by its name, or a latitude-longitude picture by its path. OpenEXR and Radiance HDR store
/// linear light; other pictures count as sRGB unless they declare another curve. Also returns warnings.
pub fn read_panorama(choice: &str) -> Result<(Panorama, Vec<String>), EngineError> {
    if let Some((name, bytes)) = BUILT_IN.iter().find(|(name, _)| *name == choice) {
        return decoded(name, bytes);
    }
    let path = PathBuf::from(choice);
    let is_name = !choice.contains(['.', '/', '\\']);
    let bytes = read_plain(&path, SIZE_LIMIT_BYTES).map_err(|unread| match unread {
        Unread::Missing if is_name => no_such(choice),
        other => unreadable(&path, other),
    })?;
    decoded(choice, &bytes)
}

/// Returns the error for a name that is neither an environment nor a file.
fn no_such(choice: &str) -> EngineError {
    let own = built_in_environments().collect::<Vec<_>>().join(", ");
    let advice = match nearest(choice, built_in_environments()) {
        Some(near) => format!("did you mean {near}?"),
        None => "choose one of those, or give the path of a picture".to_owned(),
    };
    let sentence = format!("there is no environment '{choice}', and no file of that name; Sabi has {own}; {advice}");
    EngineError::new(ErrorKind::Usage, sentence)
}

fn unreadable(path: &Path, unread: Unread) -> EngineError {
    let shown = path.display();
    let (kind, sentence) = match unread {
        Unread::Missing => {
            let own = built_in_environments().collect::<Vec<_>>().join(", ");
            let sentence =
                format!("there is no environment {shown}; check the path, or choose one of Sabi's own: {own}");
            (ErrorKind::MissingInput, sentence)
        }
        Unread::Folder => (
            ErrorKind::MissingInput,
            format!("{shown} is a folder; give the path of an environment in it"),
        ),
        Unread::NotPlain => (
            ErrorKind::MissingInput,
            format!("{shown} is a pipe or a device, which may have no end; give the path of a picture file"),
        ),
        Unread::TooLarge(bytes) => (
            ErrorKind::BadInput,
            format!(
                "{shown} has {} MiB; environments of up to {} MiB are read, so make it smaller",
                bytes >> 20,
                SIZE_LIMIT_BYTES >> 20
            ),
        ),
        Unread::Refused(refusal) => (ErrorKind::MissingInput, refusal.to_string()),
        Unread::Other(reason) => (ErrorKind::MissingInput, format!("{shown} cannot be read: {reason}")),
    };
    EngineError::new(kind, sentence)
}

/// Decodes the bytes of a picture file; `name` is its name in messages.
fn decoded(name: &str, bytes: &[u8]) -> Result<(Panorama, Vec<String>), EngineError> {
    let picture = sabi_image::decode(name, bytes)?;
    let is_light = matches!(picture.pixels, Pixels::F32(_));
    let linear = picture.linear_rgba(picture.color_curve());
    let of_file = picture.remarks.values.iter().chain(&picture.remarks.color);
    let of_file: Vec<String> = of_file.map(|remark| format!("it {remark}")).collect();
    drop(picture);
    let (panorama, mut remarks) = Panorama::new(linear.width, linear.height, &linear.rgba)?;
    remarks.extend(of_file);
    if let [shown, others @ ..] = sabi_image::layer_names(name, bytes)?.as_slice()
        && !others.is_empty()
    {
        remarks.push(format!(
            "it has {} layers, of which {shown} is the light",
            others.len() + 1
        ));
    }
    if !is_light {
        let weak =
            "it has no light brighter than white, so lamps and the sun will look weak; use an HDR or OpenEXR picture";
        remarks.push(weak.to_owned());
    }
    remarks
        .iter_mut()
        .for_each(|remark| *remark = format!("{name}: {remark}"));
    Ok((panorama, remarks))
}

#[cfg(test)]
mod tests;
