//! Remedies in the words of the command line: each with the flag that applies it.

use clap::{Arg, Command, CommandFactory};
use sabi_engine::Remedy;
use sabi_engine::remedy::advised;

use crate::arguments::Arguments;

/// Returns a sentence with those of its remedies that `command` can apply or that need no flag.
pub(crate) fn with_flags(sentence: &str, remedies: &[Remedy], command: &str) -> String {
    advised(sentence, remedies_with_flags(remedies, command))
}

/// Returns the remedies that `command` can apply or that need no flag, each with its flag.
pub(crate) fn remedies_with_flags(remedies: &[Remedy], command: &str) -> Vec<String> {
    let with_flag = |remedy: &Remedy| with_flag(*remedy, command);
    remedies.iter().filter_map(with_flag).collect()
}

/// Returns a remedy with the flag of `command` that applies it, or `None` if the command has no such flag.
fn with_flag(remedy: Remedy, command: &str) -> Option<String> {
    let phrases = phrases(remedy);
    if phrases.is_empty() {
        return Some(remedy.to_string());
    }
    let phrase = phrases.iter().find(|phrase| has_flag(command, phrase))?;
    Some(format!("{remedy} {phrase}"))
}

/// Returns phrases that name the flag which applies a remedy; the first one whose flag a command accepts is used. Empty if no
/// command has such a flag.
fn phrases(remedy: Remedy) -> &'static [&'static str] {
    match remedy {
        Remedy::OtherAdapter => &["with --adapter"],
        Remedy::AnyAdapter => &["with --adapter auto"],
        Remedy::SoftwareAdapter => &["with --adapter cpu"],
        Remedy::RaiseBudget => &["with --budget"],
        // `render` calls the size of the picture --size.
        Remedy::SmallerSize | Remedy::LargerSize => &["with --texels", "with --size"],
        Remedy::WithoutFusion => &["with --no-fuse"],
        Remedy::ProcessorRays => &["with --caster cpu"],
        Remedy::OtherFolder => &["with -o"],
        Remedy::IntoThisFolderAnyway => &["with --force"],
        Remedy::UnwrapModel => &["with --overlap unwrap"],
        Remedy::KeepOwnUvs => &["with --overlap first"],
        Remedy::TilesAsUdim => &["with --udim on"],
        Remedy::TilesRepeat => &["with --udim off"],
        Remedy::AllParts => &["with --parts '*'"],
        Remedy::TurnFaces => &["with --turn-faces"],
        Remedy::TextureFolder => &["with --textures"],
        Remedy::MergeOverlaps => &["with --overlap merge"],
        Remedy::WithoutModelCopy => &["by leaving out --model"],
        Remedy::OtherMaterial => &["with --material"],
        Remedy::NameModel => &["with --mesh"],
        Remedy::ReplaceStrokes => &["with --replace"],
        Remedy::ReplaceFile => &["with --force"],
        Remedy::WithoutMissingFiles => &["with --allow-missing"],
        Remedy::WithoutModel => &["with --no-mesh"],
        Remedy::TrustFile => &["with --trust"],
        Remedy::RaiseMemory => &["with --memory"],
        Remedy::CloseOtherPrograms
        | Remedy::UpdateDriver
        | Remedy::ReduceTriangles
        | Remedy::FreeSpace
        | Remedy::TryAgain
        | Remedy::AllowWriting
        | Remedy::SaveUnderOtherName
        | Remedy::SaveInOtherFolder
        | Remedy::EditUvs
        | Remedy::SaveModelAsGltf => &[],
    }
}

/// Returns whether a command, or one below it, accepts the flag that a phrase names.
fn has_flag(command: &str, phrase: &str) -> bool {
    let Some(flag) = phrase.split(' ').find(|word| word.starts_with('-')) else {
        return false;
    };
    let arguments = Arguments::command();
    let is_it = |argument: &Arg| match flag.strip_prefix("--") {
        Some(long) => argument.get_long() == Some(long),
        None => argument.get_short() == flag.chars().nth(1),
    };
    let accepts = |found: &Command| found.get_arguments().any(is_it);
    if arguments
        .get_arguments()
        .any(|known| known.is_global_set() && is_it(known))
    {
        return true;
    }
    let found = arguments.find_subcommand(command);
    found.is_some_and(|found| accepts(found) || found.get_subcommands().any(accepts))
}

#[cfg(test)]
mod tests {
    use super::{has_flag, phrases, with_flag, with_flags};
    use crate::arguments::command_names;
    use sabi_engine::Remedy;

    #[test]
    fn a_remedy_names_a_flag_that_its_command_takes() {
        let size = [Remedy::SmallerSize];
        let told = |command: &str| with_flags("it is too large", &size, command);
        assert_eq!(told("bake"), "it is too large; choose a smaller size with --size");
        assert_eq!(told("render"), "it is too large; choose a smaller size with --texels");
        assert_eq!(told("edit"), "it is too large", "the size is chosen in the window");
        let remedies = [
            Remedy::CloseOtherPrograms,
            Remedy::WithoutFusion,
            Remedy::SoftwareAdapter,
        ];
        assert_eq!(
            with_flags("the device was lost", &remedies, "preview"),
            "the device was lost; close other programs that use the graphics card, or choose the software adapter with \
             --adapter cpu"
        );
    }

    #[test]
    fn every_flag_of_a_remedy_is_one_of_some_command() {
        for &remedy in Remedy::ALL {
            for phrase in phrases(remedy) {
                let is_known = command_names().iter().any(|command| has_flag(command, phrase));
                assert!(is_known, "{remedy:?}: {phrase}");
            }
            let is_said = command_names()
                .iter()
                .any(|command| with_flag(remedy, command).is_some());
            assert!(is_said, "{remedy:?}");
        }
    }
}
