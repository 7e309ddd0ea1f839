//! What a run is asked to do.

/// How long and how carefully to trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Source rays asked for; rounded up to whole batches.
    pub rays: u64,
    pub seed: u64,
    /// Source rays per batch: a power of two, at most 2^16; `None`: chosen from `rays`.
    pub batch: Option<u64>,
    /// Both branches are followed at an interface until a path has this many reflections at interfaces; then one is drawn.
    pub splits: u16,
    /// Specular and scattered light are both followed until a path has this many scatters; then one is drawn.
    pub scatter_splits: u16,
    pub roulette: Roulette,
    /// Limits that cut and book; `None`: no limit.
    pub max_scatters: Option<u16>,
    pub max_reflections: Option<u32>,
    /// Reflections at surfaces that can transmit.
    pub max_ghosts: Option<u16>,
    /// A guard against endless paths; booked if it ever cuts.
    pub max_events: u32,
    /// Stop early at this relative error.
    pub until: Option<Until>,
    /// Rows of the path table, the fullest first.
    pub paths: usize,
    pub importance: Guidance,
    pub trace: Trace,
    pub booking: Booking,
}

/// Whether it is counted what happened on the way of the stray light that arrives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Booking {
    #[default]
    Flux,
    /// For every detector, part and kind of event.
    Events,
}

/// Which way light is followed. The expectation of every number is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trace {
    /// From the sources.
    #[default]
    Forward,
    /// From the detectors where that is possible, else from the sources.
    Backward,
}

/// Whether the run learns first where scattered light counts, tries what it learned and uses it where it pays. The expectation of
/// every number is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guidance {
    #[default]
    Auto,
    /// Uses it whether it pays or not.
    On,
    Off,
}

/// Russian roulette: a packet whose flux falls below `below` x its source ray's flux survives with probability `survive` and
/// carries flux / survive then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roulette {
    pub below: f64,
    pub survive: f64,
}

/// A wanted precision: relative standard error of a detector's flux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// Index of the detector.
    pub detector: usize,
    pub relative: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            rays: 1_000_000,
            seed: 1,
            batch: None,
            splits: 2,
            scatter_splits: 1,
            roulette: Roulette { below: 1e-12, survive: 0.1 },
            max_scatters: None,
            max_reflections: None,
            max_ghosts: None,
            max_events: 1_000_000,
            until: None,
            paths: 1000,
            importance: Guidance::default(),
            trace: Trace::default(),
            booking: Booking::default(),
        }
    }
}

impl Settings {
    /// Batches that a stated number of rays should give at least: below that an error bar is a guess.
    pub const FEWEST_BATCHES: u64 = 32;

    /// Source rays per batch: as asked, or the largest power of two up to 4096 that leaves 64 batches.
    pub fn batch_rays(&self) -> u64 {
        self.batch.unwrap_or_else(|| {
            let most = (self.rays / (2 * Self::FEWEST_BATCHES)).clamp(1, 4096);
            1 << most.ilog2()
        })
    }

    /// Batches of the whole run, at least `FEWEST_BATCHES`.
    pub fn batches(&self) -> u64 {
        self.rays.div_ceil(self.batch_rays()).max(Self::FEWEST_BATCHES)
    }
}
