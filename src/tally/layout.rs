//! Which number lives in which slot.

use crate::packet::{Class, Event};

/// Cells along each side of the coarse grid on which the peak of a path is given.
pub const PATH_GRID: usize = 16;

/// Why flux was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Net of Russian roulette: what was killed less what the survivors gained; zero on average.
    Roulette,
    /// The user's limit on scatter events.
    Scatters,
    /// The user's limit on reflections.
    Reflections,
    /// The limit on reflections at surfaces that can transmit.
    Ghosts,
    /// The limit on events of any kind.
    Events,
    /// Scatter switched off at a surface.
    ScatterOff,
}

impl Cut {
    pub const ALL: [Cut; 6] =
        [Cut::Roulette, Cut::Scatters, Cut::Reflections, Cut::Ghosts, Cut::Events, Cut::ScatterOff];

    /// As the ledger writes it.
    pub fn label(self) -> &'static str {
        ["roulette", "max_scatters", "max_reflections", "max_ghosts", "max_events", "scattering off"][self as usize]
    }
}

/// Why flux was lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// A face was crossed that contradicts the solids the packet is in.
    Crossing,
    /// Left the scene while inside a solid.
    Inside,
    /// Not a finite number.
    Number,
}

impl Loss {
    pub const ALL: [Loss; 3] = [Loss::Crossing, Loss::Inside, Loss::Number];

    /// As the ledger writes it.
    pub fn label(self) -> &'static str {
        ["inconsistent crossing", "escaped from inside a solid", "not a number"][self as usize]
    }
}

/// The address book of a run's slots.
#[derive(Clone, Debug)]
pub struct Layout {
    parts: usize,
    media: usize,
    sources: usize,
    /// First slot of each detector.
    detectors: Vec<usize>,
    /// Bins of each detector.
    bins: Vec<usize>,
    rows: usize,
    first_row: usize,
    /// Whether what happened on the way is counted.
    events: bool,
    filters: usize,
}

const CUTS: usize = Cut::ALL.len();
const LOSSES: usize = Loss::ALL.len();
/// emitted, absorbed, escaped, terminated, lost, residual; lost backwards.
const TOTALS: usize = 7;
/// What a part does to light: reflect, transmit, scatter.
const EVENTS: usize = 3;
/// Per path row: flux, flux x optical path, then the coarse grid.
const ROW: usize = 2 + PATH_GRID * PATH_GRID;
/// Per filter and detector: flux, open flux, then the bins.
const FILTER: usize = 2;

impl Layout {
    pub const EMITTED: usize = 0;
    pub const ABSORBED: usize = 1;
    pub const ESCAPED: usize = 2;
    pub const TERMINATED: usize = 3;
    pub const LOST: usize = 4;
    pub const RESIDUAL: usize = 5;
    /// Of what detectors sent out backwards: what was cut by the limit on events or lost to geometry faults, in shares.
    pub const LOST_BACKWARDS: usize = 6;

    /// Slots for so many parts, media, sources, bins per detector and path rows.
    pub fn new(parts: usize, media: usize, sources: usize, bins: Vec<usize>, rows: usize) -> Layout {
        let mut next = TOTALS + CUTS + LOSSES + parts + media;
        let detectors = bins
            .iter()
            .map(|bins| {
                let first = next;
                next += 2 + Class::COUNT + sources * (1 + Class::COUNT) + bins;
                first
            })
            .collect();
        Layout { parts, media, sources, detectors, bins, rows, first_row: next, events: false, filters: 0 }
    }

    /// The same with slots for what happened on the way of stray light.
    pub fn with_events(self) -> Layout {
        Layout { events: true, ..self }
    }

    /// The same with slots for the light that each of so many filters means.
    pub fn with_filters(self, filters: usize) -> Layout {
        Layout { filters, ..self }
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.filter(self.bins.len(), 0)
    }

    /// First slot of the filters.
    fn first_filter(&self) -> usize {
        let events = if self.events { self.bins.len() * self.events_each() } else { 0 };
        self.first_row + self.rows * ROW + events
    }

    /// Flux on a detector that a filter means.
    pub fn filter(&self, detector: usize, filter: usize) -> usize {
        let each = |bins: usize| FILTER + bins;
        let before: usize = self.bins[..detector].iter().map(|&bins| self.filters * each(bins)).sum();
        self.first_filter() + before + self.bins.get(detector).map_or(0, |&bins| filter * each(bins))
    }

    /// Flux on a detector of which it is open whether a filter means it.
    pub fn filter_open(&self, detector: usize, filter: usize) -> usize {
        self.filter(detector, filter) + 1
    }

    /// Flux in a bin of a detector that a filter means.
    pub fn filter_bin(&self, detector: usize, filter: usize, bin: usize) -> usize {
        self.filter(detector, filter) + FILTER + bin
    }

    /// Slots of the events of one detector.
    fn events_each(&self) -> usize {
        2 + EVENTS * self.parts
    }

    /// Stray flux on a detector; the next slot holds that of paths too long to be spelt. `None` where nothing is counted.
    pub fn stray(&self, detector: usize) -> Option<usize> {
        self.events.then(|| self.first_row + self.rows * ROW + detector * self.events_each())
    }

    /// Stray flux on a detector times the number of such events of a part on its path; `None` where nothing is counted.
    pub fn event(&self, detector: usize, part: usize, event: Event) -> Option<usize> {
        let kind = (event as usize) < EVENTS;
        self.stray(detector).filter(|_| kind).map(|first| first + 2 + EVENTS * part + event as usize)
    }

    /// True if there is nothing to book; never in a run.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn cut(&self, cut: Cut) -> usize {
        TOTALS + cut as usize
    }

    pub fn loss(&self, loss: Loss) -> usize {
        TOTALS + CUTS + loss as usize
    }

    pub fn part(&self, part: usize) -> usize {
        TOTALS + CUTS + LOSSES + part
    }

    pub fn medium(&self, medium: usize) -> usize {
        TOTALS + CUTS + LOSSES + self.parts + medium
    }

    /// Flux on a detector.
    pub fn detector(&self, detector: usize) -> usize {
        self.detectors[detector]
    }

    /// Flux on a detector by paths without a row.
    pub fn other(&self, detector: usize) -> usize {
        self.detectors[detector] + 1
    }

    pub fn class(&self, detector: usize, class: usize) -> usize {
        self.detectors[detector] + 2 + class
    }

    /// Flux on a detector from a source.
    pub fn source(&self, detector: usize, source: usize) -> usize {
        self.detectors[detector] + 2 + Class::COUNT + source
    }

    /// Flux of a class on a detector from a source.
    pub fn source_class(&self, detector: usize, source: usize, class: usize) -> usize {
        self.source(detector, self.sources) + source * Class::COUNT + class
    }

    pub fn bin(&self, detector: usize, bin: usize) -> usize {
        self.source_class(detector, self.sources, bin)
    }

    /// Bins of a detector.
    pub fn bins(&self, detector: usize) -> usize {
        self.bins[detector]
    }

    /// Flux of a path row, W.
    pub fn row(&self, row: usize) -> usize {
        self.first_row + row * ROW
    }

    /// Flux x optical path of a path row, W m.
    pub fn row_path(&self, row: usize) -> usize {
        self.row(row) + 1
    }

    /// Flux of a path row in a cell of the coarse grid, W.
    pub fn row_cell(&self, row: usize, cell: usize) -> usize {
        self.row(row) + 2 + cell
    }

    /// Every cell of a path row's coarse grid.
    pub fn row_cells(&self, row: usize) -> std::ops::Range<usize> {
        self.row(row) + 2..self.row(row) + ROW
    }

    /// Slots that a part or a medium absorbs in.
    pub fn absorbers(&self) -> std::ops::Range<usize> {
        let first = TOTALS + CUTS + LOSSES;
        first..first + self.parts + self.media
    }

    /// Slots of all cuts.
    pub fn cuts(&self) -> std::ops::Range<usize> {
        TOTALS..TOTALS + CUTS
    }

    /// Slots of all losses.
    pub fn losses(&self) -> std::ops::Range<usize> {
        TOTALS + CUTS..TOTALS + CUTS + LOSSES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_numbers_share_a_slot() {
        let layout = Layout::new(3, 2, 4, vec![4, 5], 6).with_events().with_filters(3);
        let mut slots: Vec<usize> = (0..TOTALS).collect();
        slots.extend(layout.cuts().chain(layout.losses()).chain(layout.absorbers()));
        for d in 0..2 {
            slots.extend([layout.detector(d), layout.other(d)]);
            slots.extend((0..Class::COUNT).map(|c| layout.class(d, c)));
            slots.extend((0..4).map(|s| layout.source(d, s)));
            slots.extend((0..4 * Class::COUNT).map(|i| layout.source_class(d, i / Class::COUNT, i % Class::COUNT)));
            slots.extend((0..layout.bins(d)).map(|b| layout.bin(d, b)));
            slots.extend(layout.stray(d).into_iter().flat_map(|first| [first, first + 1]));
            for filter in 0..3 {
                slots.extend([layout.filter(d, filter), layout.filter_open(d, filter)]);
                slots.extend((0..layout.bins(d)).map(|b| layout.filter_bin(d, filter, b)));
            }
            for event in [Event::Reflect, Event::Transmit, Event::Scatter, Event::Bulk] {
                slots.extend((0..3).filter_map(|part| layout.event(d, part, event)));
            }
        }
        for row in 0..6 {
            slots.extend([layout.row(row), layout.row_path(row)]);
            slots.extend(layout.row_cells(row));
        }
        slots.sort_unstable();
        assert_eq!(slots, (0..layout.len()).collect::<Vec<_>>());
    }
}
