//! Reader of BSDF matrices in XML, as written by LBNL WINDOW, Radiance (`genBSDF`) and others.
//!
//! By the schema BSDF-v1.4: in `WindowElement / Optical / Layer`
//!
//!     DataDefinition   IncidentDataStructure (Columns: one column per patch of incidence | Rows), and each AngleBasis: its
//!                      AngleBasisName and for every ring an AngleBasisBlock with nPhis and ThetaBounds (LowerTheta, UpperTheta, deg)
//!     WavelengthData   Wavelength (a band: Visible, Solar, ...) and WavelengthDataBlock: WavelengthDataDirection (Transmission or
//!                      Reflection, Front or Back), ColumnAngleBasis, RowAngleBasis, ScatteringData in 1/sr, by blanks or commas
//!
//! Refused with a message: tensor trees, a matrix that is given twice.

use super::klems::{Basis, Face, Matrix, Way};
use super::reading::{ENOUGH, Problem, shorten};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

/// Reads the matrices of one band of wavelengths, such as "Visible".
pub fn parse(text: &str, band: &str) -> Result<Vec<Matrix>, Vec<Problem>> {
    let document = Document::parse(text.trim_start_matches('\u{feff}')).map_err(|error| {
        let line = error.pos().row as usize;
        vec![Problem { line, message: error.to_string(), expected: "XML with a `WindowElement`".into() }]
    })?;
    let mut file = File { document: &document, problems: Vec::new() };
    let matrices = file.matrices(band);
    if file.problems.is_empty() { Ok(matrices) } else { Err(file.problems) }
}

struct File<'a, 'input> {
    document: &'a Document<'input>,
    problems: Vec<Problem>,
}

/// The first child of this name.
fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    children(node, name).next()
}

fn children<'a, 'input>(node: Node<'a, 'input>, name: &str) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// The words in the child of this name; none if there is none.
fn text<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    child(node, name).and_then(|child| child.text()).unwrap_or_default().trim()
}

impl<'a, 'input> File<'a, 'input> {
    fn fault(&mut self, at: usize, message: impl Into<String>, expected: impl Into<String>) {
        if self.problems.len() < ENOUGH {
            let line = self.document.text_pos_at(at).row as usize;
            self.problems.push(Problem { line, message: message.into(), expected: expected.into() });
        }
    }

    /// The child of this name, which must be there.
    fn need(&mut self, node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
        let found = child(node, name);
        if found.is_none() {
            let inside = node.tag_name().name().to_owned();
            self.fault(node.range().start, format!("`{inside}` has no `{name}`"), format!("`<{name}>`"));
        }
        found
    }

    fn matrices(&mut self, band: &str) -> Vec<Matrix> {
        let root = self.document.root_element();
        let layer = self.need(root, "Optical").and_then(|optical| self.need(optical, "Layer"));
        let Some((layer, definition)) = layer.and_then(|layer| Some((layer, self.need(layer, "DataDefinition")?)))
        else {
            return Vec::new();
        };
        let columns = match text(definition, "IncidentDataStructure") {
            "Columns" => true,
            "Rows" => false,
            other => {
                let found = format!("the incident data structure is `{}`", shorten(other));
                self.fault(definition.range().start, found, "Columns or Rows");
                return Vec::new();
            }
        };
        let bases = self.bases(definition);
        let mut matrices: Vec<Matrix> = Vec::new();
        let mut bands: Vec<&str> = Vec::new();
        for data in children(layer, "WavelengthData") {
            bands.push(text(data, "Wavelength"));
            if !text(data, "Wavelength").eq_ignore_ascii_case(band) {
                continue;
            }
            for block in children(data, "WavelengthDataBlock") {
                let Some(matrix) = self.matrix(block, &bases, columns) else { continue };
                if matrices.iter().any(|known| known.face == matrix.face && known.way == matrix.way) {
                    self.fault(block.range().start, "this matrix is given twice", "one matrix for each face and way");
                }
                matrices.push(matrix);
            }
        }
        if matrices.is_empty() && self.problems.is_empty() {
            bands.dedup();
            let known = format!("one of the bands {}", bands.join(", "));
            self.fault(layer.range().start, format!("the file has no matrix for the band {band:?}"), known);
        }
        matrices
    }

    /// Angle bases by name.
    fn bases(&mut self, definition: Node<'a, 'input>) -> BTreeMap<&'a str, Basis> {
        let mut bases = BTreeMap::new();
        for written in children(definition, "AngleBasis") {
            if let Some(basis) = self.basis(written) {
                bases.insert(text(written, "AngleBasisName"), basis);
            }
        }
        bases
    }

    fn basis(&mut self, written: Node<'a, 'input>) -> Option<Basis> {
        let mut rings = Vec::new();
        let mut reached = 0.0;
        for block in children(written, "AngleBasisBlock") {
            let bounds = self.need(block, "ThetaBounds")?;
            let from: f64 = self.number(bounds, "LowerTheta")?;
            let to: f64 = self.number(bounds, "UpperTheta")?;
            if (from - reached).abs() > 1e-6 {
                let gap = format!("this ring begins at {from} deg and the one before it ends at {reached} deg");
                self.fault(bounds.range().start, gap, "rings that touch, from 0 to 90 deg");
                return None;
            }
            reached = to;
            rings.push((to.to_radians(), self.number(block, "nPhis")?));
        }
        // A file of a few hundred bytes must not ask for all memory.
        let few = rings.iter().all(|(_, sectors)| *sectors <= 10_000);
        let basis = Basis::new(&rings).filter(|_| few);
        if basis.is_none() {
            let expected = "rings from 0 to 90 deg, of 1 to 10000 sectors each";
            self.fault(written.range().start, "these rings are no hemisphere", expected);
        }
        basis
    }

    fn number<T: std::str::FromStr>(&mut self, node: Node<'a, 'input>, name: &str) -> Option<T> {
        let found = self.need(node, name)?;
        let word = found.text().unwrap_or_default().trim();
        let number = word.parse().ok();
        if number.is_none() {
            self.fault(found.range().start, format!("`{}` is no number", shorten(word)), format!("a number: {name}"));
        }
        number
    }

    fn matrix(&mut self, block: Node<'a, 'input>, bases: &BTreeMap<&str, Basis>, columns: bool) -> Option<Matrix> {
        let direction = self.need(block, "WavelengthDataDirection")?;
        let (way, face) = match direction.text().unwrap_or_default().trim() {
            "Transmission Front" => (Way::Transmission, Face::Front),
            "Transmission Back" => (Way::Transmission, Face::Back),
            "Reflection Front" => (Way::Reflection, Face::Front),
            "Reflection Back" => (Way::Reflection, Face::Back),
            other => {
                let found = format!("the direction is `{}`", shorten(other));
                self.fault(direction.range().start, found, "Transmission or Reflection, Front or Back");
                return None;
            }
        };
        let [column, row] = ["ColumnAngleBasis", "RowAngleBasis"].map(|name| self.named(block, name, bases));
        let (column, row) = (column?, row?);
        let data = self.need(block, "ScatteringData")?;
        let value = self.values(data, [row.patches(), column.patches()])?;
        // Rows of the text are outgoing patches, if columns are those of incidence.
        let (incident, outgoing) = if columns { (column, row) } else { (row, column) };
        let (n, m) = (incident.patches(), outgoing.patches());
        let value = if columns { (0..n * m).map(|k| value[k % m * n + k / m]).collect() } else { value };
        Some(Matrix { face, way, incident, outgoing, value })
    }

    fn named(&mut self, block: Node<'a, 'input>, name: &str, bases: &BTreeMap<&str, Basis>) -> Option<Basis> {
        let found = self.need(block, name)?;
        let word = found.text().unwrap_or_default().trim();
        let basis = bases.get(word).cloned();
        if basis.is_none() {
            let known: Vec<&str> = bases.keys().copied().collect();
            self.fault(found.range().start, format!("no angle basis {word:?}"), format!("one of {}", known.join(", ")));
        }
        basis
    }

    /// `rows` x `columns` values, each >= 0.
    fn values(&mut self, data: Node<'a, 'input>, [rows, columns]: [usize; 2]) -> Option<Vec<f64>> {
        let before = self.problems.len();
        let Some(inside) = data.first_child() else {
            self.fault(data.range().start, "the matrix is empty", format!("{rows} x {columns} values"));
            return None;
        };
        let (start, text) = (inside.range().start, inside.text().unwrap_or_default());
        let mut value = Vec::new();
        for word in text.split([' ', '\t', '\r', '\n', ',']).filter(|word| !word.is_empty()) {
            let number = word.parse::<f64>().ok().filter(|f| f.is_finite() && *f >= 0.0);
            if number.is_none() {
                let at = start + (word.as_ptr() as usize - text.as_ptr() as usize);
                self.fault(at, format!("found `{}`", shorten(word)), "a BSDF (1/sr), 0 or more");
            }
            value.push(number.unwrap_or(0.0));
        }
        if value.len() != rows * columns {
            let found = format!("found {} values", value.len());
            self.fault(data.range().start, found, format!("{rows} x {columns} for its bases"));
        }
        (self.problems.len() == before).then_some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rings of one and two patches; light that arrives in patch i leaves in patch o with 0.1 i + 0.01 o.
    const SMALL: &str = "<?xml version=\"1.0\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\"><Optical><Layer>\n<DataDefinition>\n\
        <IncidentDataStructure>Columns</IncidentDataStructure>\n<AngleBasis><AngleBasisName>small</AngleBasisName>\n\
        <AngleBasisBlock><nPhis>1</nPhis>\n<ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>30</UpperTheta></ThetaBounds>\n</AngleBasisBlock>\n\
        <AngleBasisBlock><nPhis>2</nPhis>\n<ThetaBounds><LowerTheta>30</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds>\n</AngleBasisBlock>\n\
        </AngleBasis></DataDefinition>\n<WavelengthData><Wavelength unit=\"Integral\">Visible</Wavelength>\n<WavelengthDataBlock>\n\
        <WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n<ColumnAngleBasis>small</ColumnAngleBasis>\n\
        <RowAngleBasis>small</RowAngleBasis>\n<ScatteringData>\n0, 0.1, 0.2,\n0.01, 0.11, 0.21,\n0.02 0.12\t0.22\n</ScatteringData>\n\
        </WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>\n";

    #[test]
    fn columns_and_rows_are_told_apart() {
        for (structure, entry) in [("Columns", [0.1, 0.01]), ("Rows", [0.01, 0.1])] {
            let text = format!("\u{feff}{}", SMALL.replace("Columns", structure).replace('\n', "\r\n"));
            let matrix = parse(&text, "visible").expect("a good file").remove(0);
            assert_eq!((matrix.way, matrix.face), (Way::Reflection, Face::Back));
            for (k, value) in matrix.value.iter().enumerate() {
                let wanted = entry[0] * (k / 3) as f64 + entry[1] * (k % 3) as f64;
                assert!((value - wanted).abs() < 1e-15, "{structure}: {k}: {value}");
            }
        }
    }

    #[test]
    fn every_defect_is_named_with_its_line() {
        for (from, to, line, words) in [
            ("<Optical>", "<Mechanical>", 23, "Mechanical"),
            ("Columns", "TensorTree4", 3, "TensorTree4"),
            ("<nPhis>2</nPhis>", "<nPhis>2.5</nPhis>", 9, "2.5"),
            ("<nPhis>2</nPhis>", "<nPhis>0</nPhis>", 5, "no hemisphere"),
            ("<nPhis>2</nPhis>", "", 9, "nPhis"),
            ("<LowerTheta>30", "<LowerTheta>40", 10, "40"),
            ("<UpperTheta>90", "<UpperTheta>80", 5, "no hemisphere"),
            (">Visible<", ">Solar<", 2, "Solar"),
            ("Reflection Back", "Reflection Top", 15, "Top"),
            ("<RowAngleBasis>small", "<RowAngleBasis>large", 17, "large"),
            ("0.11", "-0.11", 20, "-0.11"),
            ("0.11", "o.11", 20, "o.11"),
            ("0.22", "", 18, "8 values"),
        ] {
            let changed = SMALL.replacen(from, to, 1);
            assert_ne!(changed, SMALL, "nothing changed by {from:?}");
            let problem = parse(&changed, "Visible").expect_err(to).remove(0);
            assert!(problem.to_string().contains(words), "{to:?}: {problem}");
            assert_eq!(problem.line, line, "{to:?}: {problem}");
        }
    }

    #[test]
    fn all_bad_numbers_are_reported_and_garbage_is_refused() {
        let bad = SMALL.replace("0.01", "x").replace("0.02", "y");
        assert_eq!(parse(&bad, "Visible").expect_err("two").len(), 2);
        let (head, block) = SMALL.split_once("<WavelengthData>").expect("a block");
        let block = block.replace("</Layer></Optical></WindowElement>", "");
        let twice = format!("{head}<WavelengthData>{block}<WavelengthData>{block}</Layer></Optical></WindowElement>");
        assert!(parse(&twice, "Visible").expect_err("twice")[0].message.contains("twice"));
        for text in ["", "<a", "<a/>", "\u{0}", "<WindowElement><Optical><Layer/></Optical></WindowElement>"] {
            assert!(parse(text, "Visible").is_err(), "{text}");
        }
    }
}
