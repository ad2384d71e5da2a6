//! Pens of graphics tablets: their events become events of the pointer, and the state of the pen is kept for each place
//! of the pointer.
//!
//! A system sends the events of a pen to a window that asks for them, instead of moving the pointer or in addition.
//! [`tablet`] reads them, [`pointer`] turns them into events, and the brush reads the places.

mod pointer;
#[cfg(all(unix, not(target_os = "macos")))]
mod protocol;
#[cfg(not(target_os = "macos"))]
mod tablet;
#[cfg(target_os = "macos")]
#[path = "pen/no_tablet.rs"]
mod tablet;

use std::time::{Duration, Instant};

use egui::{Color32, Context, Id, LayerId, Order, Pos2, RawInput};

use pointer::PenPointer;
use tablet::Tablet;

/// Sentence for systems on which tablets cannot be read directly.
const UNSUPPORTED: &str = "This system gives pens as a mouse or as fingers, with pressure where it knows that, and without tilt. \
                           Wayland and Windows give all of it.";
/// Time between two checks for a pen while none is near: shorter than a hand needs to lower a pen onto a tablet, and
/// far longer than a frame. A system does not wake the window for a pen, but events in between are not lost.
const LOOK: Duration = Duration::from_millis(50);
/// Time within which a system names its tablets.
const NAMING: Duration = Duration::from_secs(2);
/// Radius of the mark at the place of the pen, points.
const MARK: f32 = 3.0;

/// Way in which a pen is held at a place of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PenState {
    /// Pressure, 0 to 1.
    pub(crate) pressure: f32,
    /// Tilt from upright to the right and toward the hand, degrees; `None` where it is not known.
    pub(crate) tilt_degrees: Option<[f32; 2]>,
    /// True for the eraser end of the pen.
    pub(crate) is_eraser: bool,
}

impl PenState {
    /// State of a mouse: full pressure, without tilt.
    pub(crate) const MOUSE: PenState = PenState {
        pressure: 1.0,
        tilt_degrees: None,
        is_eraser: false,
    };

    /// State between two others, `share` of the way from the first to the second.
    pub(crate) fn between([from, to]: [PenState; 2], share: f32) -> PenState {
        let between = |from: f32, to: f32| from + share * (to - from);
        let tilt_degrees = match (from.tilt_degrees, to.tilt_degrees) {
            (Some(one), Some(other)) => Some([between(one[0], other[0]), between(one[1], other[1])]),
            (one, other) => one.or(other),
        };
        PenState {
            pressure: between(from.pressure, to.pressure),
            tilt_degrees,
            ..to
        }
    }
}

/// Place of the pointer that a pen reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PenPlace {
    pub(crate) at: Pos2,
    pub(crate) state: PenState,
}

/// Event of a pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PenEvent {
    /// A pen is near, with its eraser or its tip.
    Near { is_eraser: bool },
    /// The pen was at a place, logical pixels of the window, with a pressure from 0 to 1 and a tilt to the right and
    /// toward the hand, degrees, as far as its driver reports them.
    Moved {
        at: [f32; 2],
        pressure: Option<f32>,
        tilt_degrees: Option<[f32; 2]>,
    },
    /// The tip touches.
    Down,
    /// The tip is lifted.
    Up,
    /// A button of the shaft, the first or another one.
    Button { is_first: bool, is_pressed: bool },
    /// End of events that happened at the same time, since the last event of this kind.
    Frame,
    /// The pen is gone.
    Left,
}

/// Pens of the window.
#[derive(Default)]
pub(crate) struct Pens {
    pointer: PenPointer,
    link: PenConnection,
    /// Places of the pointer in this frame that a pen reported, in order.
    pub(crate) places: Vec<PenPlace>,
}

/// Connection to the tablets of the system.
#[derive(Default)]
enum PenConnection {
    /// Not connected yet: tablets are only needed for painting.
    #[default]
    Unasked,
    Connected {
        tablet: Box<Tablet>,
        since: Instant,
    },
    /// Reason that there is no connection.
    Missing(String),
}

impl Pens {
    /// Connects to the tablets of the system, once.
    pub(crate) fn connect(&mut self, frame: &eframe::Frame) {
        if !matches!(self.link, PenConnection::Unasked) {
            return;
        }
        // Frames of tests have no window.
        let Some(connected) = Tablet::connect(frame) else {
            return;
        };
        self.link = match connected {
            Ok(tablet) => PenConnection::Connected {
                tablet: Box::new(tablet),
                since: Instant::now(),
            },
            Err(why) => missing(why),
        };
    }

    /// Ends the connection, while the window is there.
    pub(crate) fn disconnect(&mut self) {
        self.link = PenConnection::Unasked;
    }

    /// Adds the events of pens since the last frame to the events of a frame. `zoom` is the size of a point, logical
    /// pixels.
    pub(crate) fn enter_frame(&mut self, raw: &mut RawInput, zoom: f32) {
        if let PenConnection::Connected { tablet, .. } = &mut self.link {
            match tablet.pump() {
                Ok(events) => self.pointer.receive(events),
                Err(why) => {
                    // Otherwise a pen that is down would stay down.
                    self.pointer.receive([PenEvent::Left]);
                    self.link = missing(why);
                }
            }
        }
        self.places = self.pointer.enter_frame(raw, zoom);
    }

    /// Requests the next frame in time, and marks the place of a pen, since not every system shows a cursor there.
    pub(crate) fn end_frame(&self, context: &Context) {
        if let Some(at) = self.pointer.place() {
            let layer = LayerId::new(Order::Debug, Id::new("pen"));
            let painter = context.layer_painter(layer);
            painter.circle_stroke(at, MARK, (2.5, Color32::BLACK));
            painter.circle_stroke(at, MARK, (1.0, Color32::WHITE));
        }
        if self.pointer.is_near() && !self.pointer.rests() {
            context.request_repaint();
            return;
        }
        let PenConnection::Connected { tablet, since } = &self.link else {
            return;
        };
        let may_come = tablet.is_known() || since.elapsed() < NAMING;
        if may_come && context.input(|input| input.focused) {
            context.request_repaint_after(LOOK);
        }
    }

    /// Sentence about the tablets of the system.
    pub(crate) fn status(&self) -> &str {
        match &self.link {
            PenConnection::Unasked => "Pens are looked for once painting begins.",
            PenConnection::Connected { tablet, .. } if tablet.is_known() => "A tablet is connected.",
            PenConnection::Connected { .. } => "No tablet is connected.",
            PenConnection::Missing(why) => why,
        }
    }

    /// Takes events as if a tablet had sent them.
    #[cfg(test)]
    pub(crate) fn receive(&mut self, events: impl IntoIterator<Item = PenEvent>) {
        self.pointer.receive(events);
    }

    /// True while events wait for the next frame.
    #[cfg(test)]
    pub(crate) fn has_waiting(&self) -> bool {
        self.pointer.has_waiting()
    }
}

/// Logs the reason that there is no connection, and returns the link.
fn missing(why: String) -> PenConnection {
    tracing::info!("{why}");
    PenConnection::Missing(why)
}
