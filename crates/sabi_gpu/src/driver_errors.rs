//! Errors that the driver reports outside of a call.

use std::sync::Mutex;

use crate::error::GpuError;

/// First error that the driver reported outside of a call, and the function to call if the device is lost.
#[derive(Default)]
pub(crate) struct DriverErrors {
    first: Mutex<Option<GpuError>>,
    /// Called once the device is lost.
    when_lost: Mutex<Option<Box<dyn FnOnce() + Send>>>,
}

impl DriverErrors {
    pub(crate) fn record(&self, error: GpuError) {
        if matches!(error, GpuError::Lost(_)) {
            let call = self.when_lost.lock().ok().and_then(|mut when_lost| when_lost.take());
            call.into_iter().for_each(|call| call());
        }
        if let Ok(mut first) = self.first.lock() {
            // The loss of a device is the cause of the errors that follow it.
            if first.is_none() || matches!(error, GpuError::Lost(_)) {
                *first = Some(error);
            }
        }
    }

    /// Sets the function to call at the first loss that is recorded after now, in place of the one set before.
    pub(crate) fn when_lost(&self, call: impl FnOnce() + Send + 'static) {
        if let Ok(mut when_lost) = self.when_lost.lock() {
            *when_lost = Some(Box::new(call));
        }
    }

    /// Loss of the device, if one was recorded.
    pub(crate) fn loss(&self) -> Option<GpuError> {
        let first = self.first.lock().ok()?;
        first.clone().filter(|error| matches!(error, GpuError::Lost(_)))
    }

    /// Takes the first error since the last call. A loss is returned by every call, since a lost device stays lost.
    pub(crate) fn take(&self) -> Result<(), GpuError> {
        let Ok(mut first) = self.first.lock() else {
            return Ok(());
        };
        let error = match &*first {
            Some(GpuError::Lost(message)) => Some(GpuError::Lost(message.clone())),
            _ => first.take(),
        };
        error.map_or(Ok(()), Err)
    }
}

/// Converts an error of the driver to one that names `what`.
pub(crate) fn driver_error(error: wgpu::Error, what: &str) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { what: what.to_owned() },
        other => GpuError::Driver(other.to_string()),
    }
}
