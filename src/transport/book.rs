//! The bookkeeper: turns what happens to packets into sums in slots.

use super::backward::Backward;
use super::paths::{Candidates, Rows};
use crate::detector::Arrival;
use crate::packet::Ancestry;
use crate::scene::Scene;
use crate::tally::layout::{Cut, Loss, PATH_GRID};
use crate::tally::{Layout, Live, Sums};

/// Books of one batch.
pub struct Book<'a, const V: usize> {
    pub layout: &'a Layout,
    pub live: Live<V>,
    /// Rows of the path table; `None` in the pilot, which collects candidates instead.
    pub rows: Option<&'a Rows>,
    pub candidates: Candidates,
    /// Flights from event to event.
    pub segments: u64,
    /// Scatter events that were drawn by importance.
    pub guided: u64,
    /// What is counted from the other end.
    pub backward: Option<&'a Backward>,
    /// The share of all rays that a unit is, while rays go backwards: they have no ledger.
    pub unit: Option<f64>,
}

impl<'a, const V: usize> Book<'a, V> {
    pub fn new(layout: &'a Layout, live: Live<V>, rows: Option<&'a Rows>) -> Book<'a, V> {
        Book {
            layout,
            live,
            rows,
            candidates: Candidates::default(),
            segments: 0,
            guided: 0,
            backward: None,
            unit: None,
        }
    }

    pub fn emitted(&mut self, flux: [f64; V]) {
        self.ledger(Layout::EMITTED, flux);
    }

    pub fn escaped(&mut self, flux: [f64; V]) {
        self.ledger(Layout::ESCAPED, flux);
    }

    pub fn absorbed_in_part(&mut self, part: u32, flux: [f64; V]) {
        self.ledger(self.layout.part(part as usize), flux);
    }

    pub fn absorbed_in_medium(&mut self, medium: u16, flux: [f64; V]) {
        self.ledger(self.layout.medium(medium as usize), flux);
    }

    pub fn cut(&mut self, cut: Cut, flux: [f64; V]) {
        self.ledger(self.layout.cut(cut), flux);
        if cut == Cut::Events {
            self.lost_backwards(flux);
        }
    }

    pub fn lost(&mut self, loss: Loss, flux: [f64; V]) {
        self.ledger(self.layout.loss(loss), flux);
        self.lost_backwards(flux);
    }

    fn ledger(&mut self, slot: usize, flux: [f64; V]) {
        if self.unit.is_none() {
            self.live.add(slot, flux);
        }
    }

    fn lost_backwards(&mut self, flux: [f64; V]) {
        if let Some(unit) = self.unit {
            self.live.add(Layout::LOST_BACKWARDS, flux.map(|flux| flux * unit));
        }
    }

    /// Light arrives at a detector; what is counted from the other end is not counted twice.
    pub fn arrived(&mut self, scene: &Scene, detector: usize, ancestry: &Ancestry, flux: [f64; V], arrival: &Arrival) {
        if !self.backward.is_some_and(|backward| backward.counts(detector, ancestry)) {
            self.counted(scene, detector, ancestry, flux, arrival);
        }
    }

    /// Light on a detector, by whichever way it was found.
    pub fn counted(&mut self, scene: &Scene, detector: usize, ancestry: &Ancestry, flux: [f64; V], arrival: &Arrival) {
        let grid = &scene.detectors[detector].grid;
        let Some(bin) = grid.bin(arrival) else { return };
        let ancestry = &*scene.ending(detector, ancestry);
        let Some(rows) = self.rows else {
            return self.candidates.note(detector, ancestry, flux.into_iter().fold(0.0, f64::max));
        };
        self.live.add(self.layout.detector(detector), flux);
        let (class, source) = (ancestry.class().index(), ancestry.source.into());
        self.live.add(self.layout.class(detector, class), flux);
        self.live.add(self.layout.source(detector, source), flux);
        self.live.add(self.layout.source_class(detector, source, class), flux);
        self.live.add(self.layout.bin(detector, bin), flux);
        if let Some(stray) = self.layout.stray(detector).filter(|_| ancestry.class() != scene.image()) {
            self.events(detector, stray, ancestry, flux);
        }
        self.filtered(scene, (detector, bin), ancestry, flux);
        match rows.find(detector, ancestry.key) {
            None => self.live.add(self.layout.other(detector), flux),
            Some(row) => {
                self.live.add(self.layout.row(row), flux);
                self.live.add(self.layout.row_path(row), flux.map(|f| f * ancestry.optical_path));
                self.live.add(self.layout.row_cell(row, coarse_cell(bin, grid.shape())), flux);
            }
        }
    }

    /// Light in a bin of a detector that filters mean, or may mean.
    fn filtered(&mut self, scene: &Scene, (detector, bin): (usize, usize), ancestry: &Ancestry, flux: [f64; V]) {
        for (number, filter) in scene.filters.iter().enumerate() {
            match filter.accepts(detector, ancestry) {
                Some(false) => {}
                Some(true) => {
                    self.live.add(self.layout.filter(detector, number), flux);
                    self.live.add(self.layout.filter_bin(detector, number, bin), flux);
                }
                None => self.live.add(self.layout.filter_open(detector, number), flux),
            }
        }
    }

    /// Stray light and what happened on its way, once for every time that it did.
    fn events(&mut self, detector: usize, stray: usize, ancestry: &Ancestry, flux: [f64; V]) {
        self.live.add(stray, flux);
        if !ancestry.is_spelled() {
            self.live.add(stray + 1, flux);
        }
        for step in &ancestry.steps {
            if let Some(slot) = self.layout.event(detector, step.number() as usize, step.event()) {
                self.live.add(slot, flux);
            }
        }
    }

    /// Closes the batch: totals and residual of the ledger.
    pub fn finish(&mut self) -> Sums<V> {
        self.live.next_ray();
        let sum = |live: &Live<V>, slots: std::ops::Range<usize>| {
            slots.fold([0.0; V], |sum, slot| std::array::from_fn(|lane| sum[lane] + live.value(slot)[lane]))
        };
        let absorbed = sum(&self.live, self.layout.absorbers());
        let terminated = sum(&self.live, self.layout.cuts());
        let lost = sum(&self.live, self.layout.losses());
        let emitted = self.live.value(Layout::EMITTED);
        let escaped = self.live.value(Layout::ESCAPED);
        let residual = std::array::from_fn(|l| emitted[l] - absorbed[l] - escaped[l] - terminated[l] - lost[l]);
        self.live.add(Layout::ABSORBED, absorbed);
        self.live.add(Layout::TERMINATED, terminated);
        self.live.add(Layout::LOST, lost);
        self.live.add(Layout::RESIDUAL, residual);
        self.live.finish()
    }
}

/// Cell of the coarse path grid in which a bin lies.
pub fn coarse_cell(bin: usize, [rows, columns]: [usize; 2]) -> usize {
    if rows == 1 {
        return bin * PATH_GRID * PATH_GRID / columns;
    }
    let (row, column) = (bin / columns, bin % columns);
    (row * PATH_GRID / rows) * PATH_GRID + column * PATH_GRID / columns
}
