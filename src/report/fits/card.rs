//! Header cards: 80 columns of printable ASCII each.

use super::RECORD;
use super::checksum::Sum;

const CARD: usize = 80;

/// Longest text between the quotes of one card.
const LONGEST: usize = 68;

/// A header under construction.
pub struct Header {
    cards: Vec<u8>,
}

impl Header {
    pub fn primary(bits: i32, shape: [usize; 2]) -> Header {
        let mut header = Header { cards: Vec::new() };
        header.word("SIMPLE", "T", "file conforms to FITS standard");
        header.layout(bits, shape);
        header.word("EXTEND", "T", "extensions follow");
        header
    }

    pub fn image(bits: i32, shape: [usize; 2]) -> Header {
        let mut header = Header { cards: Vec::new() };
        header.text("XTENSION", "IMAGE", "image extension");
        header.layout(bits, shape);
        header.word("PCOUNT", "0", "no parameters");
        header.word("GCOUNT", "1", "one group");
        header
    }

    fn layout(&mut self, bits: i32, [rows, columns]: [usize; 2]) {
        self.word("BITPIX", &bits.to_string(), "bits per value; negative: floating point");
        self.word("NAXIS", "2", "columns and rows");
        self.word("NAXIS1", &columns.to_string(), "columns");
        self.word("NAXIS2", &rows.to_string(), "rows; the first is at the bottom");
    }

    pub fn count(&mut self, key: &str, value: u64, comment: &str) {
        self.word(key, &value.to_string(), comment);
    }

    /// `value` is finite; one that is not is left out, since a header cannot say it.
    pub fn real(&mut self, key: &str, value: f64, comment: &str) {
        if !value.is_finite() {
            return;
        }
        let (mantissa, power) = split(value);
        let point = if mantissa.contains('.') { "" } else { ".0" };
        let power = if power == "0" { String::new() } else { format!("E{power}") };
        self.word(key, &format!("{mantissa}{point}{power}"), comment);
    }

    /// Quoted text. What a header cannot hold (anything but printable ASCII) becomes `?`; long text continues on CONTINUE cards.
    pub fn text(&mut self, key: &str, value: &str, comment: &str) {
        let pieces = pieces(value);
        for (index, piece) in pieces.iter().enumerate() {
            let more = if index + 1 < pieces.len() { "&" } else { "" };
            let start = if index == 0 { format!("{key:<8}= ") } else { "CONTINUE  ".into() };
            let card = format!("{start}{:<20}", format!("'{piece:<8}{more}'"));
            self.push(&if more.is_empty() { commented(&card, comment) } else { card });
        }
    }

    /// A value right-justified to column 30.
    fn word(&mut self, key: &str, value: &str, comment: &str) {
        self.push(&commented(&format!("{key:<8}= {value:>20}"), comment));
    }

    /// `card` is ASCII of at most 80 characters.
    fn push(&mut self, card: &str) {
        self.cards.extend(format!("{card:<CARD$}").bytes().take(CARD));
    }

    /// DATASUM and CHECKSUM added, ended and padded: after it, header and data add up to -0 in ones' complement.
    pub fn sealed(mut self, data: Sum) -> Vec<u8> {
        self.text("DATASUM", &data.total().to_string(), "sum of the data, ones' complement");
        let place = self.cards.len() + 11;
        self.text("CHECKSUM", "0000000000000000", "makes the whole HDU add up to -0");
        self.push("END");
        let mut bytes = self.cards;
        bytes.resize(bytes.len().next_multiple_of(RECORD), b' ');
        let mut sum = data;
        sum.add(&bytes);
        bytes[place..place + 16].copy_from_slice(&sum.complement_in_ascii());
        bytes
    }
}

/// Shortest digits that read back to the same double, and the power of ten.
fn split(value: f64) -> (String, String) {
    let written = format!("{value:e}");
    match written.split_once('e') {
        Some((mantissa, power)) => (mantissa.into(), power.into()),
        None => (written, "0".into()),
    }
}

/// The comment, if it fits.
fn commented(card: &str, comment: &str) -> String {
    let whole = format!("{card} / {comment}");
    if whole.len() <= CARD { whole } else { card.into() }
}

/// Text cut so that each piece, quotes doubled, fits between the quotes of one card with a `&` after it.
fn pieces(text: &str) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for c in text.chars() {
        let c = if c == ' ' || c.is_ascii_graphic() { c } else { '?' };
        let quoted = if c == '\'' { "''".to_owned() } else { c.to_string() };
        let last = pieces.len() - 1;
        if pieces[last].len() + quoted.len() >= LONGEST {
            pieces.push(quoted);
        } else {
            pieces[last].push_str(&quoted);
        }
    }
    pieces
}
