//! The window around the views: settings, looks, keys, layout and notices.

mod keys;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use egui::{Context, FontDefinitions, ViewportCommand};

use crate::action::SettingAction;
use crate::dock::Dock;
use crate::key_map::KeyMap;
use crate::notices::{Notices, Work};
use crate::settings::Settings;
use crate::theme::Theme;
use keys::Keyboard;

/// Frames whose times are remembered.
const MOST_FRAME_TIMES: usize = 120;

/// The window around the views.
pub(crate) struct Shell {
    pub(crate) settings: Settings,
    /// Folder of the settings, if this system has one.
    folder: Option<PathBuf>,
    /// Settings as they were saved last.
    saved_settings: serde_json::Value,
    /// Settings whose save failed, which was reported. They are not saved again until they change.
    unsaved_settings: Option<serde_json::Value>,
    pub(crate) theme: Arc<Theme>,
    pub(crate) keys: KeyMap,
    pub(crate) keyboard: Keyboard,
    pub(crate) dock: Dock,
    pub(crate) notices: Notices,
    /// Device that the window is drawn with; `None` where the window is only laid out.
    pub(crate) render: Option<RenderState>,
    /// Title that the system shows for the window.
    pub(super) title: String,
    /// Times of the last frames, without the drawing by the device.
    pub(crate) frame_times: VecDeque<Duration>,
    pub(crate) context: Context,
}

impl Shell {
    /// Creates a window with the settings of a folder.
    pub(crate) fn new(folder: Option<PathBuf>, context: &Context, render: Option<RenderState>) -> Shell {
        let (settings, fault) = Settings::load(folder.as_deref());
        let (keys, faults) = KeyMap::new(settings.input_preset, &settings.keys);
        let theme = Arc::new(Theme::of(settings.shade));
        apply_looks(context, &theme, settings.scale);
        let mut notices = Notices::default();
        for fault in faults.into_iter().chain(fault) {
            notices.fail(Work::Other, fault);
        }
        Shell {
            saved_settings: settings.to_json(),
            unsaved_settings: None,
            folder,
            theme,
            keys,
            keyboard: Keyboard::default(),
            dock: Dock::new(settings.layout.clone()),
            notices,
            render,
            title: String::new(),
            frame_times: VecDeque::new(),
            context: context.clone(),
            settings,
        }
    }

    /// Shows a notice that disappears after a while.
    pub(crate) fn notify(&mut self, sentence: impl Into<String>) {
        self.notices.notify(sentence);
    }

    /// Shows an error until the user closes it.
    pub(crate) fn fail(&mut self, sentence: impl Into<String>) {
        self.notices.fail(Work::Other, sentence);
    }

    /// Shows a refusal as a notice that disappears after a while. Returns the value if there is one.
    pub(crate) fn allow<T>(&mut self, result: Result<T, impl ToString>) -> Option<T> {
        result.map_err(|refused| self.notices.notify(refused.to_string())).ok()
    }

    /// Shows an error until the user closes it. Returns the value if there is no error.
    pub(crate) fn report<T>(&mut self, result: Result<T, impl ToString>) -> Option<T> {
        self.report_on(Work::Other, result)
    }

    /// Shows an error of some work until the user closes it or the work succeeds. Returns the value if there is no
    /// error.
    pub(crate) fn report_on<T>(&mut self, work: Work, result: Result<T, impl ToString>) -> Option<T> {
        match result {
            Ok(value) => {
                if work != Work::Other {
                    self.notices.succeed(work);
                }
                Some(value)
            }
            Err(error) => {
                self.notices.fail(work, error.to_string());
                None
            }
        }
    }

    /// Changes a setting.
    pub(crate) fn set(&mut self, action: SettingAction) {
        match action {
            SettingAction::Shade(shade) => self.settings.shade = shade,
            SettingAction::InputPreset(preset) => self.settings.input_preset = preset,
            SettingAction::Backups(backups) => {
                self.settings.backups = backups;
                return;
            }
            SettingAction::Keys(keys) => self.settings.keys = keys,
            SettingAction::Environment(environment) => {
                self.settings.environment = environment;
                return;
            }
            SettingAction::TryEffects(is_on) => {
                self.settings.tries_effects = Some(is_on);
                return;
            }
            SettingAction::ToggleFavorite(key) => {
                let favorites = &mut self.settings.favorites;
                match favorites.iter().position(|known| *known == key) {
                    Some(at) => drop(favorites.remove(at)),
                    None => favorites.push(key),
                }
                return;
            }
        }
        self.apply_settings();
    }

    /// Applies looks and keys of the settings.
    pub(crate) fn apply_settings(&mut self) {
        self.theme = Arc::new(Theme::of(self.settings.shade));
        apply_looks(&self.context, &self.theme, self.settings.scale);
        let (keys, faults) = KeyMap::new(self.settings.input_preset, &self.settings.keys);
        self.keys = keys;
        for fault in faults {
            self.fail(fault);
        }
    }

    /// Multiplies the size of the interface by a factor.
    pub(crate) fn scale_by(&mut self, factor: f32) {
        self.settings.scale = (self.settings.scale * factor).clamp(0.5, 3.0);
        self.context.set_zoom_factor(self.settings.scale);
    }

    /// Saves the settings if they have changed.
    pub(crate) fn save_settings(&mut self) {
        self.settings.layout = Some(self.dock.layout().clone());
        let Some(folder) = &self.folder else {
            return;
        };
        let now = self.settings.to_json();
        if now == self.saved_settings || self.unsaved_settings.as_ref() == Some(&now) {
            return;
        }
        match self.settings.save(folder, &self.saved_settings) {
            Ok(told) => {
                self.saved_settings = now;
                told.into_iter().for_each(|sentence| self.fail(sentence));
            }
            Err(why) => {
                self.unsaved_settings = Some(now);
                self.fail(why);
            }
        }
    }

    /// Sets the title that the system shows for the window.
    pub(crate) fn set_title(&mut self, title: String) {
        if self.title != title {
            self.context.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Remembers the time of a frame.
    pub(crate) fn add_frame_time(&mut self, time: Duration) {
        self.frame_times.push_back(time);
        while self.frame_times.len() > MOST_FRAME_TIMES {
            self.frame_times.pop_front();
        }
    }
}

/// Gives the window its fonts, colors and size.
fn apply_looks(context: &Context, theme: &Theme, scale: f32) {
    let mut fonts = FontDefinitions::default();
    egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
    context.set_fonts(fonts);
    theme.apply(context);
    // Sabi has its own commands for zooming, whose keys can be changed and whose effect is saved.
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.set_zoom_factor(scale);
}
