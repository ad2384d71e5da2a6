//! Conversion of the events of a pen to events of the pointer.

#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, TouchPhase};

use super::{PenEvent, PenPlace, PenState};

/// Largest coordinate that is accepted from a driver, in logical pixels.
const FAR: f32 = 1e6;
/// Largest tilt, degrees: a pen that lies flat has no direction on the screen.
const FLAT: f32 = 89.0;
/// Most events that wait for a frame: hours of input.
const WAITING_LIMIT: usize = 1 << 20;

/// Seconds without an event of a pen that holds no button, after which the pen counts as lying on its tablet, and the
/// mouse is used again.
const REST: f64 = 1.0;

/// The pointer that a pen moves.
#[derive(Default)]
pub(super) struct PenPointer {
    /// Events that were not added to a frame yet.
    waiting: VecDeque<PenEvent>,
    is_near: bool,
    is_eraser: bool,
    /// Place, points.
    at: Option<Pos2>,
    pressure: Option<f32>,
    tilt_degrees: Option<[f32; 2]>,
    /// True from a touch until the next place is reported, which is where it touched.
    touches: bool,
    /// Buttons that the pen holds down.
    held: Vec<PointerButton>,
    /// Time of the frame that had its last event, seconds.
    heard: Option<f64>,
    /// True if the pen was left on its tablet: it is near, but sends nothing.
    rests: bool,
}

impl PenPointer {
    /// Takes events of a pen.
    pub(super) fn receive(&mut self, events: impl IntoIterator<Item = PenEvent>) {
        let room = WAITING_LIMIT.saturating_sub(self.waiting.len());
        self.waiting.extend(events.into_iter().take(room));
    }

    /// Returns true while a pen is near, or events wait for the next frame.
    pub(super) fn is_near(&self) -> bool {
        self.is_near || !self.waiting.is_empty()
    }

    /// Returns true if a pen that is near was left on its tablet and sends nothing.
    pub(super) fn rests(&self) -> bool {
        self.rests
    }

    #[cfg(test)]
    pub(super) fn has_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Place of a pen that is near.
    pub(super) fn place(&self) -> Option<Pos2> {
        self.at.filter(|_| self.is_near)
    }

    /// Adds events to those of a frame, and returns the places of the pen among them. A frame ends when a button is
    /// pressed or released, so that a press, a movement and a release within one slow frame stay apart, each at its
    /// place.
    pub(super) fn enter_frame(&mut self, raw: &mut RawInput, zoom: f32) -> Vec<PenPlace> {
        let mut places = Vec::new();
        if !self.is_near() {
            return places;
        }
        if !self.waiting.is_empty() {
            self.heard = raw.time;
        }
        let silence = raw.time.zip(self.heard).map(|(now, heard)| now - heard);
        self.rests = self.held.is_empty() && silence.is_some_and(|silence| silence > REST);
        // Removes events that some systems send in addition: movements of the pointer, and touches of the tip as those
        // of a finger.
        raw.events.retain(|event| self.rests || !self.is_doubled(event));
        let mut told = FrameEvents {
            events: &mut raw.events,
            modifiers: raw.modifiers,
            has_button: false,
        };
        while !told.has_button {
            let Some(event) = self.waiting.pop_front() else { break };
            self.tell(event, zoom, &mut told, &mut places);
        }
        if self.waiting.is_empty() && self.touches {
            self.press_tip(&mut told);
        }
        places
    }

    /// Returns whether an event of the pointer repeats one of the pen. Releases of buttons that the pen does not hold
    /// are kept.
    fn is_doubled(&self, event: &Event) -> bool {
        match event {
            Event::PointerMoved(_) | Event::PointerGone | Event::MouseMoved(_) => true,
            // A finger that touched before the pen came may be lifted.
            Event::Touch { phase, .. } => matches!(phase, TouchPhase::Start | TouchPhase::Move),
            Event::PointerButton { button, pressed, .. } => *pressed || self.held.contains(button),
            _ => false,
        }
    }

    fn tell(&mut self, event: PenEvent, zoom: f32, told: &mut FrameEvents<'_>, places: &mut Vec<PenPlace>) {
        match event {
            PenEvent::Near { is_eraser } if self.is_near && self.is_eraser == is_eraser => {}
            PenEvent::Near { is_eraser } => {
                // The other end of the pen is near, and no event has said that the first one left.
                self.lift_all(told);
                self.is_near = true;
                self.is_eraser = is_eraser;
                (self.pressure, self.tilt_degrees) = (None, None);
            }
            PenEvent::Moved {
                at,
                pressure,
                tilt_degrees,
            } => {
                self.is_near = true;
                self.pressure = pressure
                    .and_then(finite)
                    .map(|force| force.clamp(0.0, 1.0))
                    .or(self.pressure);
                self.tilt_degrees = tilt_degrees.and_then(lean).or(self.tilt_degrees);
                places.extend(self.move_to(at, zoom, told));
            }
            PenEvent::Down => self.touches = true,
            PenEvent::Up => {
                if self.touches {
                    self.press_tip(told);
                }
                self.button(PointerButton::Primary, false, told);
            }
            PenEvent::Button { is_first, is_pressed } => {
                let button = if is_first {
                    PointerButton::Secondary
                } else {
                    PointerButton::Middle
                };
                self.button(button, is_pressed, told);
            }
            PenEvent::Frame => {
                if self.touches {
                    self.press_tip(told);
                }
            }
            PenEvent::Left => {
                self.lift_all(told);
                told.events.push(Event::PointerGone);
                *self = PenPointer {
                    waiting: std::mem::take(&mut self.waiting),
                    ..PenPointer::default()
                };
            }
        }
    }

    /// Moves the pointer, unless the place is invalid, and performs a pending press there.
    fn move_to(&mut self, at: [f32; 2], zoom: f32, told: &mut FrameEvents<'_>) -> Option<PenPlace> {
        let is_place = at.iter().all(|number| number.abs() <= FAR);
        let place = is_place.then(|| PenPlace {
            at: Pos2::from(at) / zoom,
            state: self.state(),
        });
        if let Some(place) = &place {
            self.at = Some(place.at);
            told.events.push(Event::PointerMoved(place.at));
        }
        if self.touches {
            self.press_tip(told);
        }
        place
    }

    fn state(&self) -> PenState {
        PenState {
            pressure: self.pressure.unwrap_or(PenState::MOUSE.pressure), // The tool has no pressure.
            tilt_degrees: self.tilt_degrees,
            is_eraser: self.is_eraser,
        }
    }

    fn press_tip(&mut self, told: &mut FrameEvents<'_>) {
        self.touches = false;
        self.button(PointerButton::Primary, true, told);
    }

    /// Presses or releases a button, unless it is in that state already, or the pen has no place yet.
    fn button(&mut self, button: PointerButton, pressed: bool, told: &mut FrameEvents<'_>) {
        let Some(pos) = self.at.filter(|_| self.held.contains(&button) != pressed) else {
            return;
        };
        self.held.retain(|held| *held != button);
        if pressed {
            self.held.push(button);
        }
        told.has_button = true;
        told.events.push(Event::PointerButton {
            pos,
            button,
            pressed,
            modifiers: told.modifiers,
        });
    }

    fn lift_all(&mut self, told: &mut FrameEvents<'_>) {
        self.touches = false;
        for button in self.held.clone() {
            self.button(button, false, told);
        }
    }
}

/// Events of a frame.
struct FrameEvents<'a> {
    events: &'a mut Vec<Event>,
    modifiers: Modifiers,
    /// True if a button went down or up.
    has_button: bool,
}

fn finite(number: f32) -> Option<f32> {
    number.is_finite().then_some(number)
}

/// Tilt with finite angles, no flatter than [`FLAT`]; `None` for other numbers.
fn lean(degrees: [f32; 2]) -> Option<[f32; 2]> {
    let [x, y] = degrees.map(finite);
    Some([x?, y?].map(|angle| angle.clamp(-FLAT, FLAT)))
}
