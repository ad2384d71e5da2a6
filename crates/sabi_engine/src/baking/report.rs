//! What a bake did, for people and for machines.

use std::time::{Duration, Instant};

use serde_json::{Value as Json, json};

/// Time of one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseTime {
    total: Duration,
}

impl PhaseTime {
    /// Runs something and adds the time it took.
    pub fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        self.total += started.elapsed();
        result
    }

    /// Adds time measured elsewhere.
    pub fn add(&mut self, time: Duration) {
        self.total += time;
    }

    /// All of it.
    pub fn total(&self) -> Duration {
        self.total
    }

    /// Milliseconds, to a tenth.
    pub fn ms(&self) -> f64 {
        (self.total.as_secs_f64() * 10_000.0).round() / 10.0
    }
}

/// Times of a bake's stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseTimes {
    /// Reading the graph, the model and its pictures, and bringing the surface onto the device.
    pub load: PhaseTime,
    /// Building or finding the atlas.
    pub atlas: PhaseTime,
    /// Opening the device and making kernels.
    pub compile: PhaseTime,
    /// Running the plan.
    pub run: PhaseTime,
    /// Normals, readback, padding, encoding and writing.
    pub encode: PhaseTime,
}

/// What a bake did; [`BakeReport::json`] is the report file.
#[derive(Clone, Debug)]
pub struct BakeReport {
    /// Stage times.
    pub times: PhaseTimes,
    /// Names of the files that were written.
    pub files: Vec<String>,
    /// What the artist should know.
    pub warnings: Vec<String>,
    /// The report file (DESIGN §8).
    pub json: Json,
}

impl PhaseTimes {
    /// As `stages_ms` of the report.
    pub fn json(&self) -> Json {
        json!({
            "load": self.load.ms(),
            "atlas": self.atlas.ms(),
            "compile": self.compile.ms(),
            "run": self.run.ms(),
            "encode": self.encode.ms(),
        })
    }
}
