//! Ctrl-C and requests to end: the first lets the run write what it has finished, the second ends it at once.

use signal_hook::consts::TERM_SIGNALS;
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Whether to stop, and at whose word.
pub struct Stop {
    /// Set by the first signal.
    pub asked: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
}

impl Stop {
    /// Listens from now on. A signal that cannot be listened to simply ends the program.
    pub fn listen() -> Stop {
        let stop = Stop { asked: Arc::default(), signal: Arc::default() };
        for &signal in TERM_SIGNALS {
            // In this order: at the first signal the flag is not yet set when the shutdown looks at it.
            let _ = flag::register_conditional_shutdown(signal, code(signal as usize).into(), stop.asked.clone());
            let _ = flag::register_usize(signal, stop.signal.clone(), signal as usize);
            let _ = flag::register(signal, stop.asked.clone());
        }
        stop
    }

    /// Exit code after a signal: 130 for Ctrl-C, 143 for a request to terminate.
    pub fn code(&self) -> u8 {
        code(self.signal.load(Ordering::Relaxed))
    }
}

/// 128 + the number of the signal, as shells have it.
fn code(signal: usize) -> u8 {
    128 + signal as u8
}
