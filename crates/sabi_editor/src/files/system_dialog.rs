//! System dialogs for files and folders, which do not block the window.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use egui::Context;
use rfd::{AsyncFileDialog, FileHandle};
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::library::GRAPH_EXTENSION;
use sabi_surface::load::MODEL_ENDINGS;

use crate::brush_shelf;
use crate::paths::{FONTS, IMAGES, lowercase_ending};

/// Purpose of a requested path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum PathFor {
    Open,
    Save,
    /// Archive of the graph with its files.
    Archive,
    Model,
    /// Model beside the main one.
    ModelBeside,
    /// Missing file, which the graph names by this path.
    Missing(String),
    /// Picture to add as a node, or a folder of pictures to add as texture sets.
    ImportedPictures,
    /// File for a picture of the model's view.
    Picture,
    /// Parameter that names an image file.
    Image(KnobTarget),
    /// Image file that a gradient is picked from, for a parameter.
    Gradient(KnobTarget),
    /// Picture as the tip of the brush.
    BrushPicture,
    Stencil,
    /// File of a brush.
    Brush,
    /// Font of texts that the brush stamps.
    Font,
}

impl PathFor {
    /// Title of the question.
    pub(super) fn title(&self) -> &'static str {
        match self {
            PathFor::Open => "Open a graph",
            PathFor::Save => "Save the graph",
            PathFor::Archive => "Pack the graph with all files that it uses",
            PathFor::Model => "Add a model",
            PathFor::ModelBeside => "Show a model beside the first one",
            PathFor::Missing(_) => "Find a missing file",
            PathFor::ImportedPictures => "Import a picture, or a folder of pictures",
            PathFor::Picture => "Save a picture of the view",
            PathFor::Image(_) => "Choose an image",
            PathFor::Gradient(_) => "Choose a picture to pick colors from",
            PathFor::BrushPicture => "Choose a picture for the brush to stamp",
            PathFor::Stencil => "Choose a picture to paint through",
            PathFor::Brush => "Open a brush",
            PathFor::Font => "Choose a font file",
        }
    }

    /// Label of the button that confirms.
    pub(super) fn verb(&self) -> &'static str {
        match self {
            PathFor::Open | PathFor::Brush => "Open",
            PathFor::Save | PathFor::Picture => "Save",
            PathFor::Archive => "Pack",
            PathFor::ImportedPictures => "Import",
            PathFor::Model | PathFor::ModelBeside => "Add",
            PathFor::Image(_)
            | PathFor::Gradient(_)
            | PathFor::BrushPicture
            | PathFor::Stencil
            | PathFor::Missing(_)
            | PathFor::Font => "Choose",
        }
    }

    /// True for a file that is written, and need not be there.
    pub(super) fn is_written(&self) -> bool {
        match self {
            PathFor::Save | PathFor::Archive | PathFor::Picture => true,
            PathFor::Open
            | PathFor::ImportedPictures
            | PathFor::Model
            | PathFor::ModelBeside
            | PathFor::Missing(_)
            | PathFor::Image(_)
            | PathFor::Gradient(_)
            | PathFor::BrushPicture
            | PathFor::Stencil
            | PathFor::Brush
            | PathFor::Font => false,
        }
    }

    /// Endings of the files that can be chosen, in lower case.
    pub(super) fn endings(&self) -> &'static [&'static str] {
        match self {
            PathFor::Open | PathFor::Save => &[GRAPH_EXTENSION],
            PathFor::Model | PathFor::ModelBeside => &MODEL_ENDINGS,
            PathFor::Missing(lost) => match lowercase_ending(Path::new(lost)).as_deref() {
                Some(GRAPH_EXTENSION) => &[GRAPH_EXTENSION],
                Some(ending) if MODEL_ENDINGS.contains(&ending) => &MODEL_ENDINGS,
                _ => &IMAGES,
            },
            PathFor::Picture => &["png"],
            PathFor::Archive => &["zip"],
            PathFor::ImportedPictures
            | PathFor::Image(_)
            | PathFor::Gradient(_)
            | PathFor::BrushPicture
            | PathFor::Stencil => &IMAGES,
            PathFor::Brush => &[brush_shelf::ENDING],
            PathFor::Font => &FONTS,
        }
    }
}

/// Sentence about a system without dialogs.
pub(crate) const NO_DIALOG: &str = "The system's dialog could not be opened: on Linux it needs a desktop portal \
                                    (xdg-desktop-portal), or zenity.";
/// Time in which a user cannot have closed a dialog: one that ends sooner was never opened. A quirk of `rfd`: it gives
/// the same answer for a canceled dialog and for one that could not be opened, and it may need longer than this to find
/// neither a portal nor zenity.
const AT_ONCE: Duration = Duration::from_millis(300);

/// System dialog that is open.
pub(crate) struct SystemDialog {
    answer: Receiver<DialogAnswer>,
    context: Context,
    /// True once the window has lost the focus since the dialog was asked for.
    lost_focus: Arc<AtomicBool>,
}

/// Answer of a system dialog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum DialogAnswer {
    Chosen(PathBuf),
    /// It was closed without a choice.
    Closed,
    /// The system has no such dialog.
    NotOpened,
}

impl DialogAnswer {
    /// Answer of a dialog, from the path that it gave, its duration, and whether the window has lost the focus. A
    /// dialog that was opened takes the focus, since it cannot be closed without it.
    fn after(path: Option<PathBuf>, lasted: Duration, has_lost_focus: bool) -> DialogAnswer {
        match path {
            Some(path) => DialogAnswer::Chosen(path),
            None if lasted < AT_ONCE || !has_lost_focus => DialogAnswer::NotOpened,
            None => DialogAnswer::Closed,
        }
    }
}

impl SystemDialog {
    /// Opens a dialog for a file, in the folder of the typed path.
    pub(crate) fn file(context: &Context, what: &PathFor, typed: &str) -> SystemDialog {
        let dialog = AsyncFileDialog::new();
        let dialog = match Path::new(typed).parent().filter(|folder| folder.is_dir()) {
            Some(folder) => dialog.set_directory(folder),
            None => dialog,
        };
        let kind = match what {
            PathFor::Open | PathFor::Save => "Graphs",
            PathFor::Archive => "Archives",
            PathFor::Model | PathFor::ModelBeside => "Models",
            PathFor::ImportedPictures
            | PathFor::Picture
            | PathFor::Image(_)
            | PathFor::Gradient(_)
            | PathFor::BrushPicture
            | PathFor::Stencil => "Pictures",
            PathFor::Brush => "Brushes",
            PathFor::Missing(_) => "Files of this kind",
            PathFor::Font => "Fonts",
        };
        let dialog = dialog.add_filter(kind, what.endings());
        if what.is_written() {
            SystemDialog::open(context, dialog.save_file())
        } else {
            SystemDialog::open(context, dialog.pick_file())
        }
    }

    /// Opens a dialog for a folder.
    pub(crate) fn folder(context: &Context) -> SystemDialog {
        SystemDialog::open(context, AsyncFileDialog::new().pick_folder())
    }

    /// Waits for the answer on a thread of its own, which is not joined when the window closes: the dialog may stay open for
    /// long.
    fn open(context: &Context, dialog: impl Future<Output = Option<FileHandle>> + Send + 'static) -> SystemDialog {
        let began = Instant::now();
        SystemDialog::ending(context, move || {
            let path = pollster::block_on(dialog).map(|file| file.path().to_owned());
            (path, began.elapsed())
        })
    }

    /// Waits for the end of a dialog, with the chosen path and the time for which it was there.
    pub(crate) fn ending(
        context: &Context,
        wait: impl FnOnce() -> (Option<PathBuf>, Duration) + Send + 'static,
    ) -> SystemDialog {
        let lost_focus = Arc::new(AtomicBool::new(false));
        let has_lost = lost_focus.clone();
        let mut dialog = SystemDialog::waiting(context, move || {
            let (path, lasted) = wait();
            DialogAnswer::after(path, lasted, has_lost.load(Ordering::Relaxed))
        });
        dialog.lost_focus = lost_focus;
        dialog
    }

    /// Waits for an answer on a thread of its own; `context` draws a frame when it arrives.
    pub(crate) fn waiting(context: &Context, wait: impl FnOnce() -> DialogAnswer + Send + 'static) -> SystemDialog {
        let (sender, answer) = channel();
        let woken = context.clone();
        let waiting = std::thread::Builder::new().name("sabi dialog".to_owned());
        // Without a thread, the dialog counts as not opened.
        let _ = waiting.spawn(move || {
            // Fails once the question is closed.
            let _ = sender.send(wait());
            drop(sender);
            woken.request_repaint();
        });
        SystemDialog {
            answer,
            context: context.clone(),
            lost_focus: Arc::default(),
        }
    }

    /// The answer, once it has arrived. Asked in every frame, since it watches the focus of the window, too.
    pub(crate) fn poll(&self) -> Option<DialogAnswer> {
        if !self.context.input(|input| input.raw.focused) {
            self.lost_focus.store(true, Ordering::Relaxed);
        }
        match self.answer.try_recv() {
            Ok(answer) => Some(answer),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(DialogAnswer::NotOpened),
        }
    }
}

/// Takes the answer of an open dialog, if it has arrived, and forgets the dialog.
pub(crate) fn answer_of(dialog: &mut Option<SystemDialog>) -> Option<DialogAnswer> {
    let answer = dialog.as_ref()?.poll()?;
    *dialog = None;
    Some(answer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dialog_that_ends_at_once_or_without_taking_the_focus_was_not_opened() {
        let path = PathBuf::from("a.sabi");
        let lasted = |milliseconds| Duration::from_millis(milliseconds);
        assert_eq!(DialogAnswer::after(None, lasted(5), true), DialogAnswer::NotOpened);
        assert_eq!(DialogAnswer::after(None, lasted(2000), false), DialogAnswer::NotOpened);
        assert_eq!(DialogAnswer::after(None, lasted(2000), true), DialogAnswer::Closed);
        let chosen = DialogAnswer::after(Some(path.clone()), lasted(5), false);
        assert_eq!(chosen, DialogAnswer::Chosen(path));
    }
}
