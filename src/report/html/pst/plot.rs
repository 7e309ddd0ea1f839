//! A curve over the angle from the boresight, in decades: error bars, limits as arrows, the requirement, classes.

use super::table::TONES;
use crate::report::picture::{superscript, ticks};
use crate::study::pst::{Curve, GROUPS, Point, Verdict};
use maud::{Markup, html};

/// The picture, and the space left, above, right (legend) and below the plot, in its own units: letters are 13 high.
const SIZE: [f64; 2] = [1000.0, 500.0];
const MARGIN: [f64; 4] = [74.0, 16.0, 172.0, 54.0];

/// Decades shown at most below the largest value.
const DECADES: i32 = 18;

/// Azimuths drawn at most.
const CUTS: usize = 8;

/// Colours of cuts, which differ for colour-blind eyes, too (Okabe & Ito 2008); a single one is ink.
const COLOURS: [&str; CUTS] = ["#161b22", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a7a7a"];

const FONT: &str = "font-family:Inter,'Segoe UI',system-ui,Arial,'Liberation Sans',sans-serif;font-size:13px";
const MASK: &str = "#c0182b";

/// Where values go.
struct Frame {
    /// Degrees, and exponents of ten.
    x: [f64; 2],
    y: [i32; 2],
    /// Whether angles are divided by ratios.
    ratios: bool,
}

/// The picture as SVG, which needs nothing else.
pub fn picture(curve: &Curve) -> String {
    let frame = Frame::of(curve);
    let cuts = curve.cuts();
    let step = cuts.len().div_ceil(CUTS).max(1);
    let shown: Vec<(&[Point], &str)> = cuts.iter().step_by(step).copied().zip(COLOURS).collect();
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", SIZE[0], SIZE[1])) style=(FONT) role="img"
            aria-label=(format!("PST of {} over the angle from the boresight", curve.sweep)) {
            rect width="100%" height="100%" fill="#fff" {}
            (frame.grid())
            (frame.mask(curve))
            @if let [(points, _)] = shown[..] { (frame.classes(points)) }
            @for (points, colour) in &shown { (frame.cut(points, colour)) }
            (legend(curve, &shown, cuts.len()))
        }
    }
    .into_string()
}

impl Frame {
    fn of(curve: &Curve) -> Frame {
        let angles = || curve.points.iter().map(|point| point.angle_deg);
        let (low, high) = angles().fold((f64::INFINITY, 0.0f64), |(a, b), angle| (a.min(angle), b.max(angle)));
        let ratios = low > 0.0 && high / low >= 30.0;
        let shown = |at: f64| (low..=high).contains(&at);
        let masks = curve.mask_points.iter().filter(|row| shown(row[0])).map(|row| row[1]);
        let values = curve.points.iter().flat_map(|p| [p.pst.mean, p.stray.mean, p.upper_limit.unwrap_or(0.0)]);
        let limits = curve.points.iter().filter_map(|point| Some(point.required?.limit));
        let all = values.chain(masks).chain(limits).filter(|value| *value > 0.0 && value.is_finite());
        let (least, most) = all.fold((f64::INFINITY, 0.0f64), |(a, b), value| (a.min(value), b.max(value)));
        let y = if most > 0.0 {
            let top = (most.log10() + 0.1).ceil() as i32;
            [((least.log10() - 0.3).floor() as i32).max(top - DECADES).min(top - 1), top]
        } else {
            [-1, 0]
        };
        let x = match ratios {
            true => [low / 1.15, high * 1.15],
            false if low == high => [low - 1.0, high + 1.0],
            false => [if low < 0.2 * high { 0.0 } else { low }, high + 0.02 * (high - low)],
        };
        Frame { x, y, ratios }
    }

    fn x(&self, angle: f64) -> f64 {
        let place = if self.ratios {
            (angle / self.x[0]).ln() / (self.x[1] / self.x[0]).ln()
        } else {
            (angle - self.x[0]) / (self.x[1] - self.x[0])
        };
        MARGIN[0] + place * (SIZE[0] - MARGIN[0] - MARGIN[2])
    }

    /// Values below the lowest decade lie on it.
    fn y(&self, value: f64) -> f64 {
        let [low, high] = self.y.map(f64::from);
        let place = if value > 0.0 { ((value.log10() - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
        MARGIN[1] + (1.0 - place) * self.height()
    }

    fn height(&self) -> f64 {
        SIZE[1] - MARGIN[1] - MARGIN[3]
    }

    /// Angles with marks.
    fn marks(&self) -> Vec<(f64, String)> {
        if self.ratios {
            let all = (-3..3).flat_map(|power| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(power)));
            return all.filter(|a| (self.x[0]..=self.x[1]).contains(a)).map(|a| (a, a.to_string())).collect();
        }
        let [from, to] = self.x;
        ticks(from, to, 10).into_iter().map(|(place, text)| (from + place * (to - from), text)).collect()
    }

    fn grid(&self) -> Markup {
        let [left, right] = [MARGIN[0], SIZE[0] - MARGIN[2]];
        let [top, bottom] = [MARGIN[1], SIZE[1] - MARGIN[3]];
        let step = ((self.y[1] - self.y[0]) as usize).div_ceil(14).max(1);
        html! {
            @for power in (self.y[0]..=self.y[1]).step_by(step) {
                @let y = self.y(10f64.powi(power));
                (line([left, y], [right, y], "#e2e5e9", 1.0))
                text x=(px(left - 9.0)) y=(px(y + 4.5)) text-anchor="end" fill="#5a6470" { "10" (superscript(power)) }
            }
            @for (angle, text) in self.marks() {
                @let x = self.x(angle);
                (line([x, bottom], [x, bottom + 5.0], "#161b22", 1.0))
                text x=(px(x)) y=(px(bottom + 20.0)) text-anchor="middle" fill="#5a6470" { (text) }
            }
            rect x=(px(left)) y=(px(top)) width=(px(right - left)) height=(px(bottom - top)) fill="none" stroke="#161b22" {}
            text x=(px(0.5 * (left + right))) y=(px(bottom + 43.0)) text-anchor="middle" fill="#161b22" { "angle from the boresight, deg" }
            text transform=(format!("translate(20 {:.1}) rotate(-90)", 0.5 * (top + bottom))) text-anchor="middle" fill="#161b22" { "PST" }
        }
    }

    /// The requirement, and above it what it forbids.
    fn mask(&self, curve: &Curve) -> Markup {
        let points: Vec<String> = self.limits(curve).iter().map(|p| format!("{:.1},{:.1}", p[0], p[1])).collect();
        let ends = self.limits(curve).first().zip(self.limits(curve).last()).map(|(a, b)| [a[0], b[0]]);
        html! {
            @if let Some([from, to]) = ends {
                polygon fill=(MASK) fill-opacity="0.06"
                    points=(format!("{} {to:.1},{top:.1} {from:.1},{top:.1}", points.join(" "), top = MARGIN[1])) {}
                polyline fill="none" stroke=(MASK) stroke-width="1.6" stroke-dasharray="7 4" points=(points.join(" ")) {}
            }
        }
    }

    /// Places of the rows of the mask, cut off where the plot ends; straight in between, as the mask is, unless angles are divided by ratios.
    fn limits(&self, curve: &Curve) -> Vec<[f64; 2]> {
        let pieces = curve.mask_points.windows(2).flat_map(|pair| {
            let ([a, low], [b, high]) = (pair[0], pair[1]);
            let (from, to) = (a.max(self.x[0]), b.min(self.x[1]));
            let part = move |angle: f64| if b > a { (angle - a) / (b - a) } else { 0.0 };
            let count = if from > to { 0 } else { 25 };
            (0..count).map(move |k| {
                let angle = from + f64::from(k) / 24.0 * (to - from);
                let value = if b > a {
                    low * (high / low).powf(part(angle))
                } else if k < 12 {
                    low
                } else {
                    high
                };
                [self.x(angle), self.y(value)]
            })
        });
        pieces.collect()
    }

    /// Thin curves of what the PST is made of; that of the signal is broad, for the PST lies on it.
    fn classes(&self, points: &[Point]) -> Markup {
        html! {
            @for (group, tone) in TONES.iter().enumerate() {
                @for run in points.split(|point| point.groups[group].mean <= 10f64.powi(self.y[0])) {
                    @let places: Vec<[f64; 2]> = run.iter().map(|p| [self.x(p.angle_deg), self.y(p.groups[group].mean)]).collect();
                    (polyline(&places, tone, if group == 0 { 5.0 } else { 1.4 }))
                    @if let [[x, y]] = places[..] { circle cx=(px(x)) cy=(px(y)) r="2.2" fill=(tone) {} }
                }
            }
        }
    }

    /// One azimuth: a line through what arrived, bars of one standard error, arrows where nothing did, verdicts.
    fn cut(&self, points: &[Point], colour: &str) -> Markup {
        let lit = |point: &&Point| point.pst.mean > 0.0;
        let place = |point: &Point| [self.x(point.angle_deg), self.y(point.pst.mean)];
        html! {
            @for run in points.split(|point| point.pst.mean <= 0.0) {
                (polyline(&run.iter().map(place).collect::<Vec<_>>(), colour, 2.0))
            }
            @for point in points.iter().filter(lit) {
                @let [x, y] = place(point);
                @let [low, high] = [-1.0, 1.0].map(|sign| self.y(point.pst.mean + sign * point.pst.error));
                (line([x, low], [x, high], colour, 1.3))
                @if low - high > 8.0 {
                    @for end in [low, high] { (line([x - 4.0, end], [x + 4.0, end], colour, 1.3)) }
                }
                circle cx=(px(x)) cy=(px(y)) r="3.2" fill=(colour) {}
            }
            @for point in points.iter() {
                @let x = self.x(point.angle_deg);
                @if let Some(upper) = point.upper_limit { (arrow([x, self.y(upper)], colour)) }
                @if let Some(required) = point.required.filter(|required| required.verdict != Verdict::Pass) {
                    @let y = self.y(point.upper_limit.unwrap_or(point.stray.mean));
                    @let tone = if required.verdict == Verdict::Fail { MASK } else { "#e08a00" };
                    circle cx=(px(x)) cy=(px(y)) r="7.5" fill="none" stroke=(tone) stroke-width="2" {}
                }
            }
        }
    }
}

/// An upper limit: a bar, and an arrow that points down from it.
fn arrow([x, y]: [f64; 2], colour: &str) -> Markup {
    html! {
        (line([x - 5.0, y], [x + 5.0, y], colour, 1.6))
        (line([x, y], [x, y + 20.0], colour, 1.3))
        polygon fill=(colour) points=(format!("{:.1},{:.1} {:.1},{:.1} {x:.1},{:.1}", x - 4.0, y + 17.0, x + 4.0, y + 17.0, y + 25.0)) {}
    }
}

fn legend(curve: &Curve, shown: &[(&[Point], &str)], all: usize) -> Markup {
    let single = shown.len() == 1;
    let mut rows: Vec<(String, &str, f64, &str)> = Vec::new();
    for (points, colour) in shown {
        let name = if single { "PST, all light".to_owned() } else { format!("azimuth {}°", points[0].azimuth_deg) };
        rows.push((name, colour, 2.0, "none"));
    }
    if single {
        let there = |group: &usize| shown[0].0.iter().any(|point| point.groups[*group].mean > 0.0);
        rows.extend(
            (0..GROUPS.len())
                .filter(there)
                .map(|group| (GROUPS[group].to_owned(), TONES[group], if group == 0 { 5.0 } else { 1.4 }, "none")),
        );
    }
    if !curve.mask_points.is_empty() {
        rows.push(("limit for stray light".into(), MASK, 1.6, "7 4"));
    }
    let has = |verdict: Verdict| curve.points.iter().any(|p| p.required.is_some_and(|r| r.verdict == verdict));
    let rings = [(Verdict::Fail, "fails", MASK), (Verdict::NotResolved, "not resolved", "#e08a00")];
    let rings: Vec<_> = rings.into_iter().filter(|ring| has(ring.0)).collect();
    let left = SIZE[0] - MARGIN[2] + 14.0;
    let y = |row: usize| MARGIN[1] + 12.0 + 21.0 * row as f64;
    html! {
        @for (row, (name, colour, width, dash)) in rows.iter().enumerate() {
            line x1=(px(left)) x2=(px(left + 22.0)) y1=(px(y(row))) y2=(px(y(row))) style=(format!("stroke:{colour};stroke-width:{width};stroke-dasharray:{dash}")) {}
            text x=(px(left + 29.0)) y=(px(y(row) + 4.5)) fill="#161b22" { (name) }
        }
        @for (row, (_, name, tone)) in rings.iter().enumerate() {
            @let y = y(rows.len() + row);
            circle cx=(px(left + 11.0)) cy=(px(y)) r="6.5" fill="none" stroke=(tone) stroke-width="2" {}
            text x=(px(left + 29.0)) y=(px(y + 4.5)) fill="#161b22" { (name) }
        }
        @if shown.len() < all {
            text x=(px(left)) y=(px(y(rows.len() + rings.len()) + 4.5)) fill="#5a6470" { (shown.len()) " of " (all) " azimuths" }
        }
    }
}

fn polyline(places: &[[f64; 2]], colour: &str, width: f64) -> Markup {
    let points: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    html! {
        @if points.len() > 1 {
            polyline fill="none" stroke=(colour) stroke-width=(width) stroke-linejoin="round" points=(points.join(" ")) {}
        }
    }
}

fn line([x1, y1]: [f64; 2], [x2, y2]: [f64; 2], colour: &str, width: f64) -> Markup {
    html! {
        line x1=(px(x1)) y1=(px(y1)) x2=(px(x2)) y2=(px(y2)) style=(format!("stroke:{colour};stroke-width:{width}")) {}
    }
}

/// A length to a tenth of a unit.
pub fn px(length: f64) -> String {
    format!("{length:.1}")
}
