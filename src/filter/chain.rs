//! The whole way of the light, from its source to a detector, with gaps.

use super::Steps;
use crate::packet::{Ancestry, Step};

/// An ordered pattern over source, steps and detector.
#[derive(Clone, Debug)]
pub struct Chain {
    links: Vec<Link>,
}

/// What stands between two `>`.
#[derive(Clone, Debug)]
pub enum Link {
    /// `...`: anything, or nothing.
    Gap,
    /// Sources by number.
    Source(Vec<bool>),
    Steps(Steps),
    /// Detectors by number.
    Detector(Vec<bool>),
}

/// What a path consists of.
#[derive(Clone, Copy)]
enum Token {
    Source(usize),
    Step(Step),
    Detector(usize),
}

impl Link {
    fn takes(&self, token: Token) -> bool {
        match (self, token) {
            (Link::Gap, _) => true,
            (Link::Source(sources), Token::Source(source)) => sources[source],
            (Link::Steps(steps), Token::Step(step)) => steps.has(step),
            (Link::Detector(detectors), Token::Detector(detector)) => detectors[detector],
            _ => false,
        }
    }
}

impl Chain {
    /// Most links: a set of places is kept in the bits of a word.
    pub const MOST: usize = 60;

    /// A chain of at most `MOST` links.
    pub fn new(links: Vec<Link>) -> Chain {
        Chain { links }
    }

    /// Whether a path to `detector` is such a way; `None` if its tail, which is not spelled out, decides.
    pub fn holds(&self, detector: usize, path: &Ancestry) -> Option<bool> {
        let mut places = self.take(self.rested(1), Token::Source(path.source.into()));
        for step in &path.steps {
            places = self.take(places, Token::Step(*step));
        }
        if path.is_spelled() {
            return Some(self.take(places, Token::Detector(detector)) >> self.links.len() & 1 == 1);
        }
        let end = |places: u64| self.take(places, Token::Detector(detector)) >> self.links.len() & 1 == 1;
        if !end(self.within_reach(places, path)) {
            return Some(false);
        }
        // A last gap, or one before the detector, swallows whatever the tail is.
        let ends = self.links.last().is_some_and(|link| link.takes(Token::Detector(detector)));
        let last = self.links.len() - 1;
        let gap = |at: usize| matches!(self.links[at], Link::Gap) && places >> at & 1 == 1;
        (gap(last) || (ends && last > 0 && gap(last - 1))).then_some(true)
    }

    /// Places that steps which are not spelled out may lead to.
    fn within_reach(&self, mut places: u64, path: &Ancestry) -> u64 {
        for (at, link) in self.links.iter().enumerate() {
            if let Link::Steps(steps) = link
                && places >> at & 1 == 1
                && steps.may_follow(path)
            {
                places = self.rested(places | 1 << (at + 1));
            }
        }
        places
    }

    /// Places in the chain (bits: so many links are done) after one more token.
    fn take(&self, places: u64, token: Token) -> u64 {
        let mut next = 0;
        for (at, link) in self.links.iter().enumerate().filter(|(at, link)| places >> at & 1 == 1 && link.takes(token))
        {
            next |= if matches!(link, Link::Gap) { 1 << at } else { 1 << (at + 1) };
        }
        self.rested(next)
    }

    /// The same, and the places that are reached by leaving gaps empty.
    fn rested(&self, mut places: u64) -> u64 {
        for (at, link) in self.links.iter().enumerate() {
            if matches!(link, Link::Gap) && places >> at & 1 == 1 {
                places |= 1 << (at + 1);
            }
        }
        places
    }
}
