//! The views of the window, each with its own state.

use crate::canvas::Canvas;
use crate::context::View;
use crate::dock::Panel;
use crate::files::Questions;
use crate::files::key_list::KeyList;
use crate::files::start::StartPage;
use crate::flat_view::FlatView;
use crate::gradient_picker::GradientPicker;
use crate::model_view::ModelView;
use crate::panels::export::ExportPanel;
use crate::panels::history::HistoryPanel;
use crate::panels::library::LibraryPanel;
use crate::panels::node_page::NodePage;
use crate::panels::parameters::Parameters;
use crate::panels::problems::Problems;
use crate::panels::stack::StackPanel;
use crate::panels::timing::Timing;

/// The views of the window, each with its own state.
pub(crate) struct Views {
    pub(crate) canvas: Canvas,
    pub(crate) model: ModelView,
    pub(crate) flat: FlatView,
    pub(crate) parameters: Parameters,
    pub(crate) layers: StackPanel,
    pub(crate) library: LibraryPanel,
    pub(crate) export: ExportPanel,
    pub(crate) history: HistoryPanel,
    pub(crate) problems: Problems,
    pub(crate) timing: Timing,
    pub(crate) page: NodePage,
    pub(crate) questions: Questions,
    pub(crate) gradient_picker: GradientPicker,
    pub(crate) start: StartPage,
    pub(crate) key_list: KeyList,
}

impl Views {
    /// View in a panel.
    pub(crate) fn in_panel(&mut self, panel: Panel) -> &mut dyn View {
        match panel {
            Panel::Canvas => &mut self.canvas,
            Panel::Viewport => &mut self.model,
            Panel::Flat => &mut self.flat,
            Panel::Parameters => &mut self.parameters,
            Panel::Stack => &mut self.layers,
            Panel::Library => &mut self.library,
            Panel::Export => &mut self.export,
            Panel::History => &mut self.history,
            Panel::Problems => &mut self.problems,
            Panel::Timing => &mut self.timing,
            Panel::Page => &mut self.page,
        }
    }
}
