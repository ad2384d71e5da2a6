//! Remedies: changes to a request, as values that a front end describes with its flag or offers as a button.

use std::fmt;

use strum::VariantArray;

/// Change to a request, a file or the machine after which what failed can succeed, or a warning no longer applies.
///
/// Its text is plain English without flags and buttons, such as `choose a smaller size`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, VariantArray)]
pub enum Remedy {
    /// Another adapter in place of the chosen one.
    OtherAdapter,
    /// The adapter that Sabi prefers, in place of a named one.
    AnyAdapter,
    /// The software adapter.
    SoftwareAdapter,
    /// Fewer programs that use the graphics card at the same time.
    CloseOtherPrograms,
    /// A newer graphics driver.
    UpdateDriver,
    /// More memory for textures.
    RaiseBudget,
    /// Fewer texels along a side of the maps.
    SmallerSize,
    /// More texels along a side of the maps.
    LargerSize,
    /// A separate kernel for each node, so that one that does not compile affects no other node.
    WithoutFusion,
    /// Rays cast by the processor.
    ProcessorRays,
    /// A model with fewer triangles.
    ReduceTriangles,
    /// Another folder for the results.
    OtherFolder,
    /// The chosen folder, although it holds files of another origin.
    IntoThisFolderAnyway,
    /// Free space on the disk.
    FreeSpace,
    /// The same request once more.
    TryAgain,
    /// Permission to write to the file that is to be replaced.
    AllowWriting,
    /// Another file for the graph.
    SaveUnderOtherName,
    /// Another folder for the graph.
    SaveInOtherFolder,
    /// The model with a UV layout made by Sabi, in which no charts overlap.
    UnwrapModel,
    /// The model with its own UVs, although they repeat.
    KeepOwnUvs,
    /// Separate maps for each UV tile.
    TilesAsUdim,
    /// One set of maps for all UV tiles.
    TilesRepeat,
    /// All parts of the model, collision hulls and coarser levels of detail as well.
    AllParts,
    /// The faces of the model that are inside out turned around.
    TurnFaces,
    /// A folder that contains the missing pictures of the model.
    TextureFolder,
    /// The mean of all charts that share a place on the maps.
    MergeOverlaps,
    /// Other UVs, made in a modeling program.
    EditUvs,
    /// Maps without a copy of the model.
    WithoutModelCopy,
    /// The model saved as `.gltf`, whose copy refers to its maps as separate files.
    SaveModelAsGltf,
    /// Another material of the model.
    OtherMaterial,
    /// A model named by the user, in place of one that comes with Sabi.
    NameModel,
    /// The strokes in place of those that are on the model already.
    ReplaceStrokes,
    /// The new file in place of the existing one.
    ReplaceFile,
    /// An archive without the missing files.
    WithoutMissingFiles,
    /// An archive without a model.
    WithoutModel,
    /// Trust in the file, or in its folder.
    TrustFile,
    /// More memory for a model.
    RaiseMemory,
}

impl Remedy {
    /// All remedies.
    pub const ALL: &'static [Remedy] = Remedy::VARIANTS;
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Remedy::OtherAdapter => "choose another adapter",
            Remedy::AnyAdapter => "let Sabi choose the adapter",
            Remedy::SoftwareAdapter => "choose the software adapter",
            Remedy::CloseOtherPrograms => "close other programs that use the graphics card",
            Remedy::UpdateDriver => "update the graphics driver",
            Remedy::RaiseBudget => "raise the budget",
            Remedy::SmallerSize => "choose a smaller size",
            Remedy::LargerSize => "choose a larger size",
            Remedy::WithoutFusion => "run every node in a pass of its own",
            Remedy::ProcessorRays => "trace rays on the processor",
            Remedy::ReduceTriangles => "reduce the model's triangles",
            Remedy::OtherFolder => "choose another folder",
            Remedy::IntoThisFolderAnyway => "write into this folder anyway",
            Remedy::FreeSpace => "free some space on the disk",
            Remedy::TryAgain => "try again",
            Remedy::AllowWriting => "allow writing to it",
            Remedy::SaveUnderOtherName => "save under another name",
            Remedy::SaveInOtherFolder => "save in another folder",
            Remedy::UnwrapModel => "unwrap the model",
            Remedy::KeepOwnUvs => "keep the model's own UVs",
            Remedy::TilesAsUdim => "make maps for each UV tile",
            Remedy::TilesRepeat => "take the UV tiles for a texture that repeats",
            Remedy::AllParts => "take all parts",
            Remedy::TurnFaces => "turn them around",
            Remedy::TextureFolder => "choose the folder in which they are",
            Remedy::MergeOverlaps => "take the mean of overlapping charts",
            Remedy::EditUvs => "change the UVs in a modeling program",
            Remedy::WithoutModelCopy => "do without the copy of the model",
            Remedy::ReplaceStrokes => "replace the strokes there",
            Remedy::ReplaceFile => "replace the file",
            Remedy::WithoutMissingFiles => "pack without what is missing",
            Remedy::WithoutModel => "pack without a model",
            Remedy::SaveModelAsGltf => "save the model as .gltf, whose copy keeps its maps beside it",
            Remedy::OtherMaterial => "choose another material",
            Remedy::NameModel => "name a model",
            Remedy::RaiseMemory => "give it more memory",
            Remedy::TrustFile => "trust it or its folder",
        })
    }
}

/// Joins a sentence and its remedies, each in the words of a front end: `the disk is full; free some space, or try again`.
pub fn advised(sentence: &str, remedies: impl IntoIterator<Item = impl fmt::Display>) -> String {
    let words: Vec<String> = remedies.into_iter().map(|remedy| remedy.to_string()).collect();
    match words.as_slice() {
        [] => sentence.to_owned(),
        [only] => format!("{sentence}; {only}"),
        [others @ .., last] => format!("{sentence}; {}, or {last}", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Remedy, advised};

    #[test]
    fn remedies_follow_their_sentence_as_a_list() {
        let said = |remedies: &[Remedy]| advised("the disk is full", remedies);
        assert_eq!(said(&[]), "the disk is full");
        assert_eq!(said(&[Remedy::TryAgain]), "the disk is full; try again");
        assert_eq!(
            said(&[Remedy::SmallerSize, Remedy::OtherFolder]),
            "the disk is full; choose a smaller size, or choose another folder"
        );
        assert_eq!(
            said(&[Remedy::TryAgain, Remedy::SmallerSize, Remedy::OtherFolder]),
            "the disk is full; try again, choose a smaller size, or choose another folder"
        );
    }

    #[test]
    fn each_remedy_is_listed_once_and_has_words_of_its_own() {
        let listed: BTreeSet<Remedy> = Remedy::ALL.iter().copied().collect();
        let words: BTreeSet<String> = Remedy::ALL.iter().map(ToString::to_string).collect();
        assert_eq!((listed.len(), words.len()), (Remedy::ALL.len(), Remedy::ALL.len()));
    }
}
