//! Remedies of errors and warnings: a button where an action of the window applies one, words otherwise.

use egui::{Color32, Label, RichText, Ui};
use sabi_editing::command::DocumentCommand;
use sabi_engine::Remedy;
use sabi_engine::opening::linked_model::Overlap;
use sabi_engine::remedy::advised;
use sabi_surface::atlas::Udim;
use sabi_surface::load::PartChoice;

use crate::action::{Action, ExportAction, ModelAction};
use crate::bars::WORKING_SIZES;
use crate::import_options::ImportOptions;
use crate::notices::with_capital;
use crate::settings::export::{ExportChoices, SIZES as EXPORT_SIZES};

/// Request that an error or a warning is about.
#[derive(Clone, Copy)]
pub(crate) enum Request<'a> {
    /// Evaluation of the open graph at a size, texels along a side.
    Evaluation { size: u32 },
    /// Export with these choices.
    Export(&'a ExportChoices),
}

/// Shows a sentence with the remedies that have no button in words, and the buttons of the others below it.
pub(crate) fn show(
    ui: &mut Ui,
    color: Color32,
    sentence: &str,
    remedies: &[Remedy],
    request: Request<'_>,
    import: &ImportOptions,
) -> Option<Action> {
    let offered = |remedy: &Remedy| button(*remedy, request, import);
    let words = remedies.iter().filter(|remedy| offered(remedy).is_none());
    let text = advised(sentence, words);
    let lines: Vec<String> = text.lines().map(with_capital).collect();
    let text = lines.join("\n");
    ui.add(Label::new(RichText::new(text).color(color)).wrap());
    let buttons: Vec<(String, Action)> = remedies.iter().filter_map(offered).collect();
    if buttons.is_empty() {
        return None;
    }
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for (label, action) in buttons {
            if ui.button(label).clicked() {
                chosen = Some(action);
            }
        }
    });
    chosen
}

/// Label and action of the button that applies a remedy to a request; `None` where the window has no such action.
fn button(remedy: Remedy, request: Request<'_>, import: &ImportOptions) -> Option<(String, Action)> {
    let reread = |options: ImportOptions| Action::Model(ModelAction::Read(options));
    let read = |overlap: Overlap| {
        reread(ImportOptions {
            overlap,
            ..import.clone()
        })
    };
    let tiles = |udim: Udim| reread(ImportOptions { udim, ..import.clone() });
    match (remedy, request) {
        (Remedy::SmallerSize, Request::Evaluation { size }) => smaller_working_size(size),
        (Remedy::LargerSize, Request::Evaluation { size }) => {
            let larger = WORKING_SIZES.into_iter().find(|offered| *offered > size);
            larger.map(working_size)
        }
        (Remedy::SmallerSize, Request::Export(choices)) => {
            let smaller = EXPORT_SIZES.into_iter().rev().find(|offered| *offered < choices.size);
            smaller.map(|size| export_size(size, choices))
        }
        (Remedy::LargerSize, Request::Export(choices)) => {
            let larger = EXPORT_SIZES.into_iter().find(|offered| *offered > choices.size);
            larger.map(|size| export_size(size, choices))
        }
        (Remedy::UnwrapModel, _) => Some(("Unwrap the model".to_owned(), read(Overlap::Unwrap))),
        (Remedy::KeepOwnUvs, _) => Some(("Keep the model's UVs".to_owned(), read(Overlap::First))),
        (Remedy::TilesAsUdim, _) => Some(("Maps for each UV tile".to_owned(), tiles(Udim::On))),
        (Remedy::TilesRepeat, _) => Some(("One set of maps for all UV tiles".to_owned(), tiles(Udim::Off))),
        (Remedy::MergeOverlaps, _) => Some(("Average overlapping UVs".to_owned(), read(Overlap::Merge))),
        (Remedy::AllParts, _) => {
            let parts = PartChoice::all();
            let all = ImportOptions {
                parts,
                ..import.clone()
            };
            Some(("Take all parts".to_owned(), reread(all)))
        }
        (Remedy::TurnFaces, _) => {
            let turned = ImportOptions {
                turn_faces: true,
                ..import.clone()
            };
            Some(("Turn faces that are inside out".to_owned(), reread(turned)))
        }
        (Remedy::IntoThisFolderAnyway, Request::Export(_)) => {
            let action = ExportAction::Start { force: true };
            Some(("Write the textures there anyway".to_owned(), Action::Export(action)))
        }
        (Remedy::TryAgain, Request::Export(_)) => {
            let action = ExportAction::Start { force: false };
            Some(("Export again".to_owned(), Action::Export(action)))
        }
        (Remedy::WithoutModelCopy, Request::Export(choices)) => {
            Some(("Leave out the model".to_owned(), without_model(choices)))
        }
        (Remedy::IntoThisFolderAnyway | Remedy::TryAgain | Remedy::WithoutModelCopy, Request::Evaluation { .. })
        | (
            Remedy::OtherAdapter
            | Remedy::AnyAdapter
            | Remedy::SoftwareAdapter
            | Remedy::CloseOtherPrograms
            | Remedy::UpdateDriver
            | Remedy::RaiseBudget
            | Remedy::WithoutFusion
            | Remedy::ProcessorRays
            | Remedy::ReduceTriangles
            | Remedy::OtherFolder
            | Remedy::FreeSpace
            | Remedy::AllowWriting
            | Remedy::SaveUnderOtherName
            | Remedy::SaveInOtherFolder
            | Remedy::EditUvs
            | Remedy::ReplaceStrokes
            | Remedy::ReplaceFile
            | Remedy::WithoutMissingFiles
            | Remedy::WithoutModel
            | Remedy::TrustFile
            | Remedy::RaiseMemory
            | Remedy::SaveModelAsGltf
            | Remedy::OtherMaterial
            // The panel Problems has a button for each missing picture.
            | Remedy::TextureFolder
            | Remedy::NameModel,
            _,
        ) => None,
    }
}

fn smaller_working_size(size: u32) -> Option<(String, Action)> {
    let smaller = WORKING_SIZES.into_iter().rev().find(|offered| *offered < size);
    smaller.map(working_size)
}

fn without_model(choices: &ExportChoices) -> Action {
    Action::Export(ExportAction::Choose(ExportChoices {
        has_model: false,
        ..choices.clone()
    }))
}

fn working_size(size: u32) -> (String, Action) {
    let action = Action::edit(DocumentCommand::SetSize(size));
    (format!("Work at {size} texels"), action)
}

fn export_size(size: u32, choices: &ExportChoices) -> (String, Action) {
    let choices = ExportChoices {
        size,
        ..choices.clone()
    };
    let action = Action::Export(ExportAction::Choose(choices));
    (format!("Export at {size} texels"), action)
}

#[cfg(test)]
mod tests {
    use sabi_editing::command::EditCommand;

    use super::*;

    #[test]
    fn a_smaller_size_is_the_next_one_that_is_offered() {
        let import = &ImportOptions::default();
        let offered = |size: u32| button(Remedy::SmallerSize, Request::Evaluation { size }, import);
        let Some((label, Action::Edit(EditCommand::Document(DocumentCommand::SetSize(512))))) = offered(1024) else {
            panic!("512 is the next smaller size");
        };
        assert_eq!(label, "Work at 512 texels");
        assert!(offered(256).is_none(), "nothing smaller is offered");
        let choices = ExportChoices::default();
        let Some((label, Action::Export(ExportAction::Choose(chosen)))) =
            button(Remedy::SmallerSize, Request::Export(&choices), import)
        else {
            panic!("exports have smaller sizes");
        };
        assert_eq!((label.as_str(), chosen.size), ("Export at 1024 texels", 1024));
    }

    #[test]
    fn a_model_is_unwrapped_with_its_other_options_kept() {
        let import = &ImportOptions {
            uv: 1,
            ..ImportOptions::default()
        };
        let request = Request::Evaluation { size: 512 };
        let Some((_, Action::Model(ModelAction::Read(read)))) = button(Remedy::UnwrapModel, request, import) else {
            panic!("the window can unwrap a model");
        };
        assert_eq!((read.overlap, read.uv), (Overlap::Unwrap, 1));
    }

    #[test]
    fn a_remedy_that_the_window_cannot_apply_has_no_button() {
        let request = Request::Evaluation { size: 512 };
        for remedy in [Remedy::SoftwareAdapter, Remedy::TryAgain, Remedy::RaiseBudget] {
            assert!(
                button(remedy, request, &ImportOptions::default()).is_none(),
                "{remedy:?}"
            );
        }
    }
}
