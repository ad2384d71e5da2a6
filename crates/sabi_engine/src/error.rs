//! Errors, divided by who can correct them, each with its cause and its remedies as values.

use std::error::Error;
use std::fmt;
use std::io;
use std::sync::Arc;

use sabi_export::ExportError;
use sabi_files::{FileError, Refusal, StagedError};
use sabi_gpu::GpuError;
use sabi_graph::nearest;
use sabi_image::ImageError;
use sabi_surface::atlas::AtlasError;
use sabi_surface::load::{LoadError, ModelFault, listed};
use sabi_view::ViewError;
use strum::VariantArray;

use crate::remedy::{Remedy, advised};

/// Kind of failure. The command line has an exit code for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
pub enum ErrorKind {
    /// The request is not valid: a wrong name, type or range.
    Usage,
    /// No adapter can be used.
    NoAdapter,
    /// A file is damaged, or is not of the expected kind.
    BadInput,
    /// A file is missing or cannot be read.
    MissingInput,
    /// Textures do not fit into memory, or into their budget. Smaller ones would fit.
    OutOfMemory,
    /// Results cannot be written.
    CannotWrite,
    /// The user stopped it.
    Interrupted,
    /// A defect of Sabi.
    Defect,
}

impl ErrorKind {
    /// All kinds.
    pub const ALL: &'static [ErrorKind] = ErrorKind::VARIANTS;
}

/// Most sentences of an error.
const MOST_SENTENCES: usize = 200;
/// Maximum length of a sentence in bytes. A path and a few names fit.
const LONGEST_SENTENCE: usize = 8192;
/// Number of bytes that are kept at the beginning and at the end of a longer sentence, which contain the request and the remedy.
const LEFT_OF_SENTENCE: [usize; 2] = [2048, 1024];

/// Removes the middle of a sentence that is too long to be read.
pub(crate) fn shorten(sentence: &mut String) {
    if sentence.len() <= LONGEST_SENTENCE {
        return;
    }
    let [first, last] = LEFT_OF_SENTENCE;
    let start = sentence.floor_char_boundary(first);
    let end = sentence.ceil_char_boundary(sentence.len() - last);
    let left_out = format!(" [… {} bytes are left out …] ", end - start);
    sentence.replace_range(start..end, &left_out);
}

/// Failure of a request.
///
/// Its text is its sentences followed by its remedies, without flags and buttons. [`Error::source`] gives the error of the
/// crate below that it comes from. Two errors are equal if their kinds, sentences and remedies are.
#[derive(Clone, Debug)]
pub struct EngineError {
    /// Kind of failure.
    pub kind: ErrorKind,
    /// Description of the failure, in one or more sentences.
    pub messages: Vec<String>,
    /// Remedies for the user, best first.
    pub remedies: Vec<Remedy>,
    cause: Option<Arc<dyn Error + Send + Sync>>,
}

/// Maximum number of parts of a model that a sentence names.
const MOST_PARTS_NAMED: usize = 8;

impl EngineError {
    /// An error of one sentence.
    pub fn new(kind: ErrorKind, message: impl fmt::Display) -> EngineError {
        EngineError::several(kind, vec![message.to_string()])
    }

    /// Creates an error with several sentences. A file may cause any number of long sentences, so both are limited.
    pub fn several(kind: ErrorKind, mut messages: Vec<String>) -> EngineError {
        let left_out = messages.len().saturating_sub(MOST_SENTENCES);
        if left_out > 0 {
            messages.truncate(MOST_SENTENCES);
            messages.push(format!("{left_out} more sentences of this kind are left out"));
        }
        for message in &mut messages {
            shorten(message);
        }
        EngineError {
            kind,
            messages,
            remedies: Vec::new(),
            cause: None,
        }
    }

    /// Creates an error with the text of its cause.
    pub fn of(kind: ErrorKind, cause: impl Error + Send + Sync + 'static) -> EngineError {
        EngineError::new(kind, &cause).caused_by(cause)
    }

    /// Adds the error that is its cause.
    #[must_use]
    pub fn caused_by(mut self, cause: impl Error + Send + Sync + 'static) -> EngineError {
        self.cause = Some(Arc::new(cause));
        self
    }

    /// Replaces the remedies, best first.
    #[must_use]
    pub fn with_remedies(mut self, remedies: impl IntoIterator<Item = Remedy>) -> EngineError {
        self.remedies = remedies.into_iter().collect();
        self
    }

    /// Creates an error about a file that may not be opened.
    pub(crate) fn refused(refusal: &Refusal) -> EngineError {
        let remedy = refusal.folder().map(|_| Remedy::TrustFile);
        EngineError::of(ErrorKind::MissingInput, refusal.clone()).with_remedies(remedy)
    }

    /// Returns the refusal to open a file, if that is the cause.
    pub fn refusal(&self) -> Option<&Refusal> {
        let cause = self.source()?;
        match cause.downcast_ref::<LoadError>().map(|error| &error.fault) {
            Some(ModelFault::Refused { refusal, .. }) => Some(refusal),
            _ => cause.downcast_ref(),
        }
    }

    /// Creates an error about names that no part of a model has, with a sentence for each.
    fn no_such_parts(model: &str, unknown: &[String], there: &[String]) -> EngineError {
        let sentence = |name: &String| {
            let names = || there.iter().map(String::as_str);
            let advice = match nearest(name.trim_matches('*'), names()) {
                Some(near) => format!("the nearest is `{near}`"),
                None => format!("it has {}", listed(names(), MOST_PARTS_NAMED)),
            };
            format!("{model}: it has no part `{name}`; {advice}")
        };
        EngineError::several(ErrorKind::Usage, unknown.iter().map(sentence).collect())
    }

    /// Replaces each sentence by the result of `say`.
    #[must_use]
    pub(crate) fn map_messages(mut self, say: impl Fn(&str) -> String) -> EngineError {
        self.messages = self.messages.iter().map(|message| say(message)).collect();
        self.messages.iter_mut().for_each(shorten);
        self
    }
}

impl PartialEq for EngineError {
    fn eq(&self, other: &EngineError) -> bool {
        let read = |error: &EngineError| (error.kind, error.messages.clone(), error.remedies.clone());
        read(self) == read(other)
    }
}

impl Eq for EngineError {}

impl fmt::Display for EngineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&advised(&self.messages.join("\n"), &self.remedies))
    }
}

impl Error for EngineError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.cause {
            Some(cause) => Some(cause.as_ref()),
            None => None,
        }
    }
}

impl From<GpuError> for EngineError {
    fn from(error: GpuError) -> Self {
        let (kind, remedies): (ErrorKind, &[Remedy]) = match &error {
            GpuError::Canceled => (ErrorKind::Interrupted, &[]),
            GpuError::Scene(_) | GpuError::Node { .. } => (ErrorKind::BadInput, &[]),
            GpuError::TooLong { .. } => (ErrorKind::BadInput, &[Remedy::OtherAdapter]),
            // Tables grow with the triangles or with the texels.
            GpuError::TooLarge { .. } => (
                ErrorKind::BadInput,
                &[Remedy::SmallerSize, Remedy::ReduceTriangles, Remedy::OtherAdapter],
            ),
            GpuError::TooDeep { .. } => (ErrorKind::BadInput, &[Remedy::ProcessorRays]),
            GpuError::OverBudget { .. } => (ErrorKind::OutOfMemory, &[Remedy::RaiseBudget, Remedy::SmallerSize]),
            GpuError::OverMemory { .. } => (ErrorKind::OutOfMemory, &[Remedy::RaiseMemory, Remedy::SmallerSize]),
            GpuError::OutOfMemory { .. } => (ErrorKind::OutOfMemory, &[Remedy::SmallerSize, Remedy::SoftwareAdapter]),
            GpuError::NoAdapter => (ErrorKind::NoAdapter, &[]),
            GpuError::NoSuchAdapter { .. } => (ErrorKind::NoAdapter, &[Remedy::OtherAdapter, Remedy::AnyAdapter]),
            GpuError::Unsuitable { .. } | GpuError::Driver(_) => (ErrorKind::NoAdapter, &[Remedy::OtherAdapter]),
            GpuError::Lost(_) => (
                ErrorKind::NoAdapter,
                &[Remedy::CloseOtherPrograms, Remedy::SoftwareAdapter],
            ),
            GpuError::Kernel { .. } => (ErrorKind::NoAdapter, &[Remedy::WithoutFusion, Remedy::OtherAdapter]),
            GpuError::Defect(_) | GpuError::ResultGone => (ErrorKind::Defect, &[]),
        };
        EngineError::of(kind, error).with_remedies(remedies.iter().copied())
    }
}

impl From<ViewError> for EngineError {
    fn from(error: ViewError) -> Self {
        match error {
            ViewError::Gpu(error) => error.into(),
            ViewError::Size { .. } => EngineError::of(ErrorKind::Usage, error),
            ViewError::Panorama { .. } | ViewError::Prefiltered(_) => EngineError::of(ErrorKind::BadInput, error),
        }
    }
}

impl From<ImageError> for EngineError {
    fn from(error: ImageError) -> Self {
        EngineError::of(kind_of_picture(&error), error)
    }
}

/// Returns the kind of an error of reading or writing a picture.
fn kind_of_picture(error: &ImageError) -> ErrorKind {
    match error {
        ImageError::Empty { .. }
        | ImageError::Unsupported { .. }
        | ImageError::Pointer { .. }
        | ImageError::Feature { .. }
        | ImageError::Damaged { .. }
        | ImageError::TooLarge { .. } => ErrorKind::BadInput,
        ImageError::Layer { .. } => ErrorKind::Usage,
        ImageError::Encode { .. } => ErrorKind::Defect,
    }
}

impl From<ExportError> for EngineError {
    fn from(error: ExportError) -> Self {
        let (kind, remedies): (ErrorKind, &[Remedy]) = match &error {
            ExportError::Write { source, .. } if is_full(source) => {
                (ErrorKind::CannotWrite, &[Remedy::FreeSpace, Remedy::OtherFolder])
            }
            ExportError::CreateFolder { .. }
            | ExportError::Write { .. }
            | ExportError::Input { .. }
            | ExportError::NotAFile { .. } => (ErrorKind::CannotWrite, &[Remedy::OtherFolder]),
            ExportError::Replace { .. } => (ErrorKind::CannotWrite, &[]),
            ExportError::Model { .. } => (ErrorKind::BadInput, &[Remedy::TryAgain, Remedy::WithoutModelCopy]),
            ExportError::CopyTooLarge { .. } => (ErrorKind::BadInput, &[Remedy::SmallerSize, Remedy::SaveModelAsGltf]),
            ExportError::Names { .. }
            | ExportError::SameName { .. }
            | ExportError::SameLetters { .. }
            | ExportError::SameDocument { .. } => (ErrorKind::BadInput, &[]),
            ExportError::Encode { source, .. } => (kind_of_picture(source), &[]),
            ExportError::WrongSize { .. } => (ErrorKind::Defect, &[]),
        };
        EngineError::of(kind, error).with_remedies(remedies.iter().copied())
    }
}

fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded)
}

impl From<FileError> for EngineError {
    fn from(error: FileError) -> Self {
        ExportError::from(error).into()
    }
}

impl From<StagedError> for EngineError {
    fn from(error: StagedError) -> Self {
        ExportError::from(error).into()
    }
}

impl From<LoadError> for EngineError {
    fn from(error: LoadError) -> Self {
        let kind = match &error.fault {
            ModelFault::Memory { .. } => ErrorKind::OutOfMemory,
            ModelFault::NoSuchPart { .. } | ModelFault::NoPart => ErrorKind::Usage,
            _ if error.is_missing() => ErrorKind::MissingInput,
            _ => ErrorKind::BadInput,
        };
        let remedies: &[Remedy] = match &error.fault {
            ModelFault::Refused { refusal, .. } if refusal.folder().is_some() => &[Remedy::TrustFile],
            ModelFault::Memory { .. } => &[Remedy::RaiseMemory, Remedy::ReduceTriangles],
            ModelFault::NoPart => &[Remedy::AllParts],
            _ => &[],
        };
        if let ModelFault::NoSuchPart { unknown, there } = &error.fault {
            let told = EngineError::no_such_parts(&error.model, unknown, there);
            return told.with_remedies([Remedy::AllParts]).caused_by(error);
        }
        EngineError::of(kind, error).with_remedies(remedies.iter().copied())
    }
}

impl From<AtlasError> for EngineError {
    fn from(error: AtlasError) -> Self {
        let remedies: &[Remedy] = match &error {
            AtlasError::NoUdimNumber { .. } => &[Remedy::EditUvs, Remedy::TilesRepeat],
            AtlasError::UvTooFar { .. } => &[Remedy::EditUvs, Remedy::UnwrapModel],
            AtlasError::ChartTooLarge { .. } | AtlasError::TooManyTexels { .. } => {
                &[Remedy::SmallerSize, Remedy::EditUvs, Remedy::UnwrapModel]
            }
            AtlasError::Memory { .. } => &[Remedy::SmallerSize, Remedy::UnwrapModel, Remedy::RaiseMemory],
            _ => &[],
        };
        let kind = match &error {
            AtlasError::Memory { .. } => ErrorKind::OutOfMemory,
            _ => ErrorKind::BadInput,
        };
        EngineError::of(kind, error).with_remedies(remedies.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use std::error::Error;
    use std::io;

    use sabi_export::ExportError;
    use sabi_gpu::GpuError;
    use sabi_surface::atlas::AtlasError;
    use sabi_view::ViewError;

    use super::{EngineError, ErrorKind};
    use crate::remedy::Remedy;

    #[test]
    fn a_problem_that_a_smaller_bake_solves_is_not_the_adapters_fault() {
        let of = |error: GpuError| EngineError::from(error).kind;
        let (needed_mib, budget_mib) = (9, 4);
        let over = GpuError::OverBudget { needed_mib, budget_mib };
        assert_eq!(of(over), ErrorKind::OutOfMemory);
        let what = "a texture".to_owned();
        assert_eq!(of(GpuError::OutOfMemory { what }), ErrorKind::OutOfMemory);
        assert_eq!(of(GpuError::NoAdapter), ErrorKind::NoAdapter);
        assert_eq!(of(GpuError::Canceled), ErrorKind::Interrupted);
        assert_eq!(of(GpuError::Defect("a slot is empty".to_owned())), ErrorKind::Defect);
    }

    #[test]
    fn an_error_has_the_text_of_its_cause_and_its_remedies() {
        let (needed_mib, budget_mib) = (9, 4);
        let error = EngineError::from(GpuError::OverBudget { needed_mib, budget_mib });
        assert_eq!(
            error.to_string(),
            "the textures need 9 MiB, more than the budget of 4 MiB; raise the budget, or choose a smaller size"
        );
        assert_eq!(error.remedies, [Remedy::RaiseBudget, Remedy::SmallerSize]);
        let left_mib = 4;
        let error = EngineError::from(GpuError::OverMemory { needed_mib, left_mib });
        assert_eq!(error.kind, ErrorKind::OutOfMemory);
        assert_eq!(error.remedies, [Remedy::RaiseMemory, Remedy::SmallerSize]);
        let far = AtlasError::UvTooFar {
            vertex: 3,
            u: "1e9".to_owned(),
            v: "0".to_owned(),
            size: 64,
        };
        assert_eq!(EngineError::from(far).remedies, [Remedy::EditUvs, Remedy::UnwrapModel]);
    }

    #[test]
    fn the_length_of_an_error_is_limited() {
        let long = format!("unknown kind '{}'; choose another one", "ä".repeat(1 << 20));
        let error = EngineError::several(ErrorKind::BadInput, vec![long; 5000]);
        assert_eq!(error.messages.len(), 201);
        assert!(error.to_string().len() < 1 << 20);
        let [first, .., last] = error.messages.as_slice() else {
            panic!("several")
        };
        assert!(
            first.starts_with("unknown kind 'ä") && first.ends_with("ä'; choose another one"),
            "{first}"
        );
        assert!(first.contains("[… 2094"), "{first}");
        assert_eq!(last, "4800 more sentences of this kind are left out");
        let again = error.clone().map_messages(|message| format!("graph.sabi: {message}"));
        assert_eq!(again.messages.len(), 201);
        assert!(again.messages[0].starts_with("graph.sabi: unknown kind"));
    }

    #[test]
    fn the_cause_of_an_error_is_kept_as_a_value() {
        let lost = GpuError::Lost("it was unplugged".to_owned());
        let error = EngineError::from(ViewError::Gpu(lost.clone()));
        let cause = error.source().and_then(|cause| cause.downcast_ref::<GpuError>());
        assert_eq!(cause, Some(&lost));
        let copy = error.clone();
        assert!(copy.source().is_some(), "a copy has the same cause");
        assert_eq!(
            EngineError::new(ErrorKind::Usage, "no such view")
                .source()
                .map(ToString::to_string),
            None
        );
    }

    #[test]
    fn only_for_a_full_disk_is_free_space_a_remedy() {
        let remedies = |kind: io::ErrorKind| {
            let (path, source) = ("out/a.png".into(), kind.into());
            EngineError::from(ExportError::Write { path, source }).remedies
        };
        let full = [Remedy::FreeSpace, Remedy::OtherFolder];
        assert_eq!(remedies(io::ErrorKind::StorageFull), full);
        assert_eq!(remedies(io::ErrorKind::QuotaExceeded), full);
        assert_eq!(remedies(io::ErrorKind::PermissionDenied), [Remedy::OtherFolder]);
    }
}
