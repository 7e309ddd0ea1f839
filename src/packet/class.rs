//! Classes of light: what it did on its way, in a word.

/// What kind of light arrived (PHYSICS: signal and stray).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Through the optics as the designer meant: transmissions and designed mirrors only.
    Signal,
    /// From the source without touching anything: a leak if the system has optics, else the signal.
    Direct,
    /// No scatter, n unintended reflections.
    Ghost(u16),
    /// n scatter events, whatever else.
    Scatter(u16),
}

impl Class {
    pub const MOST_GHOSTS: u16 = 6;
    pub const MOST_SCATTERS: u16 = 8;
    /// Number of classes.
    pub const COUNT: usize = 2 + Self::MOST_GHOSTS as usize + Self::MOST_SCATTERS as usize;

    /// 0..COUNT.
    pub fn index(self) -> usize {
        match self {
            Class::Signal => 0,
            Class::Direct => 1,
            Class::Ghost(n) => 1 + n as usize,
            Class::Scatter(n) => 1 + Self::MOST_GHOSTS as usize + n as usize,
        }
    }

    /// Inverse of `index`.
    pub fn from_index(index: usize) -> Class {
        let ghosts = Self::MOST_GHOSTS as usize;
        match index {
            0 => Class::Signal,
            1 => Class::Direct,
            i if i < 2 + ghosts => Class::Ghost((i - 1) as u16),
            i => Class::Scatter((i - 1 - ghosts) as u16),
        }
    }

    /// As reports write it: "signal", "direct leak" ("direct" where nothing else could be the signal), "ghost 2", "scatter 8+".
    pub fn label(self, has_optics: bool) -> String {
        let more = |n: u16, most: u16| if n == most { format!("{n}+") } else { n.to_string() };
        match self {
            Class::Signal => "signal".into(),
            Class::Direct if has_optics => "direct leak".into(),
            Class::Direct => "direct".into(),
            Class::Ghost(n) => format!("ghost {}", more(n, Self::MOST_GHOSTS)),
            Class::Scatter(n) => format!("scatter {}", more(n, Self::MOST_SCATTERS)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_and_indices_are_inverse() {
        for i in 0..Class::COUNT {
            assert_eq!(Class::from_index(i).index(), i);
        }
    }
}
