//! The bookkeeper: turns what happens to packets into sums in slots.

use super::paths::{Candidates, Rows};
use crate::detector::Arrival;
use crate::packet::Packet;
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
}

impl<'a, const V: usize> Book<'a, V> {
    pub fn new(layout: &'a Layout, live: Live<V>, rows: Option<&'a Rows>) -> Book<'a, V> {
        Book { layout, live, rows, candidates: Candidates::default(), segments: 0 }
    }

    pub fn emitted(&mut self, flux: [f64; V]) {
        self.live.add(Layout::EMITTED, flux);
    }

    pub fn escaped(&mut self, flux: [f64; V]) {
        self.live.add(Layout::ESCAPED, flux);
    }

    pub fn absorbed_in_part(&mut self, part: u32, flux: [f64; V]) {
        self.live.add(self.layout.part(part as usize), flux);
    }

    pub fn absorbed_in_medium(&mut self, medium: u16, flux: [f64; V]) {
        self.live.add(self.layout.medium(medium as usize), flux);
    }

    pub fn cut(&mut self, cut: Cut, flux: [f64; V]) {
        self.live.add(self.layout.cut(cut), flux);
    }

    pub fn lost(&mut self, loss: Loss, flux: [f64; V]) {
        self.live.add(self.layout.loss(loss), flux);
    }

    /// Light arrives at a detector.
    pub fn arrived(&mut self, scene: &Scene, detector: usize, packet: &Packet<V>, arrival: &Arrival) {
        let grid = &scene.detectors[detector].grid;
        let Some(bin) = grid.bin(arrival) else { return };
        let Some(rows) = self.rows else { return self.candidates.note(detector, packet) };
        let flux = packet.fluxes();
        let ancestry = &packet.ancestry;
        self.live.add(self.layout.detector(detector), flux);
        self.live.add(self.layout.class(detector, ancestry.class().index()), flux);
        self.live.add(self.layout.bin(detector, bin), flux);
        match rows.find(detector, ancestry.key) {
            None => self.live.add(self.layout.other(detector), flux),
            Some(row) => {
                self.live.add(self.layout.row(row), flux);
                self.live.add(self.layout.row_path(row), flux.map(|f| f * ancestry.optical_path));
                self.live.add(self.layout.row_cell(row, coarse_cell(bin, grid.shape())), flux);
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
