//! The file is taken apart again by code that shares nothing with the writer.

use super::*;

struct Unit {
    cards: Vec<String>,
    data: Vec<u8>,
    /// Header and data as they stand in the file.
    whole: Vec<u8>,
}

impl Unit {
    fn value(&self, key: &str) -> Option<String> {
        let card = self.cards.iter().find(|card| card[..8].trim_end() == key)?;
        let value = card[10..].trim();
        Some(match value.strip_prefix('\'') {
            Some(text) => text.split('\'').next().unwrap().trim_end().to_owned(),
            None => value.split('/').next().unwrap().trim().to_owned(),
        })
    }

    fn number(&self, key: &str) -> f64 {
        self.value(key).unwrap().parse().unwrap()
    }
}

/// Splits a file at its END cards and its declared sizes.
fn units(mut bytes: &[u8]) -> Vec<Unit> {
    let mut units = Vec::new();
    while !bytes.is_empty() {
        let cards: Vec<String> = bytes
            .chunks_exact(80)
            .map(|card| String::from_utf8(card.to_vec()).unwrap())
            .take_while(|card| card.trim_end() != "END")
            .collect();
        let header = ((cards.len() + 1) * 80).div_ceil(2880) * 2880;
        let mut unit = Unit { cards, data: Vec::new(), whole: Vec::new() };
        let length = (unit.number("NAXIS1") * unit.number("NAXIS2") * 8.0) as usize;
        let end = header + length.div_ceil(2880) * 2880;
        assert!(bytes[header + length..end].iter().all(|&byte| byte == 0), "data padding");
        unit.data = bytes[header..header + length].to_vec();
        unit.whole = bytes[..end].to_vec();
        units.push(unit);
        bytes = &bytes[end..];
    }
    units
}

/// Ones' complement sum by long addition: a carry is brought around as it appears.
fn sum(bytes: &[u8]) -> u32 {
    bytes.chunks_exact(4).fold(0u32, |sum, word| {
        let (next, carry) = sum.overflowing_add(u32::from_be_bytes(word.try_into().unwrap()));
        next + u32::from(carry)
    })
}

fn map(rows: usize, columns: usize) -> MapResult {
    let bins = rows * columns;
    let axis = |name: &str| Axis { name: name.into(), unit: "m", start: -1e-3 * columns as f64, step: 2e-3 };
    MapResult {
        detector: "focal plane 'A'".into(),
        filter: None,
        kind: MapKind::Plane,
        shape: [rows, columns],
        axes: Some([axis("x"), axis("y")]),
        unit: "W/m2",
        mean: (0..bins).map(|bin| (bin as f64).sqrt() * 1e-7).collect(),
        error: vec![1e-9; bins],
        rays: (0..bins as u64).collect(),
        upper: vec![0.0; bins],
        extent: vec![4e-6; bins],
        origin: [0.0, 0.0, 0.1],
        column_direction: [1.0, 0.0, 0.0],
        row_direction: [0.0, 1.0, 0.0],
        side: "front",
    }
}

fn file(map: &MapResult, system: &str) -> Vec<u8> {
    let results = Results {
        system: system.into(),
        rays: 1 << 20,
        rays_requested: 1_000_000,
        seed: u64::MAX,
        batch_rays: 4096,
        batches: 256,
        detectors: Default::default(),
        ledger_w: Default::default(),
        absorbed_w: Default::default(),
        lost_w: Default::default(),
        terminated_w: Default::default(),
        warnings: Vec::new(),
        trusted: true,
        parameters: Default::default(),
        finishes: Vec::new(),
        importance: None,
        filters: Vec::new(),
        inputs: Default::default(),
        path_grid: 16,
        paths: Vec::new(),
        maps: Vec::new(),
    };
    let run = RunInfo {
        version: "0.1.0".into(),
        threads: 1,
        seconds: 1.0,
        rays_per_s: 1.0,
        segments: 1,
        segments_per_s: 1.0,
        host: String::new(),
        interrupted: false,
        command: String::new(),
    };
    let mut bytes = Vec::new();
    write(&mut bytes, map, &results, &run).unwrap();
    bytes
}

#[test]
fn header_and_data_add_up_to_minus_zero_for_every_shape() {
    for (rows, columns) in [(1, 1), (1, 7), (3, 5), (13, 1), (360, 1), (19, 101)] {
        let bytes = file(&map(rows, columns), "A system");
        assert_eq!(bytes.len() % 2880, 0);
        for unit in units(&bytes) {
            assert_eq!(sum(&unit.whole), u32::MAX, "CHECKSUM of {rows} x {columns}");
            let mut padded = unit.data.clone();
            padded.resize(padded.len().next_multiple_of(2880), 0);
            assert_eq!(unit.value("DATASUM").unwrap(), sum(&padded).to_string());
        }
    }
}

#[test]
fn five_planes_hold_the_map_as_it_was() {
    let map = map(3, 5);
    let bytes = file(&map, "A system");
    let units = units(&bytes);
    let names: Vec<_> = units.iter().map(|unit| unit.value("EXTNAME").unwrap()).collect();
    assert_eq!(names, ["MEAN", "ERROR", "RAYS", "UPPER", "EXTENT"]);
    assert_eq!(units[0].value("SIMPLE").unwrap(), "T");
    assert!(units[1..].iter().all(|unit| unit.cards[0].starts_with("XTENSION= 'IMAGE   '")));
    let mean: Vec<f64> = units[0].data.chunks_exact(8).map(|b| f64::from_be_bytes(b.try_into().unwrap())).collect();
    let rays: Vec<u64> = units[2].data.chunks_exact(8).map(|b| u64::from_be_bytes(b.try_into().unwrap())).collect();
    assert_eq!(mean, map.mean);
    assert_eq!(rays, map.rays);
    assert_eq!((units[0].number("NAXIS1"), units[0].number("NAXIS2")), (5.0, 3.0));
    assert_eq!((units[0].number("BITPIX"), units[2].number("BITPIX")), (-64.0, 64.0));
}

#[test]
fn axes_give_bin_centres_in_millimetres() {
    let bytes = file(&map(3, 5), "A system");
    let primary = &units(&bytes)[0];
    assert_eq!(primary.value("CUNIT1").unwrap(), "mm");
    assert!((primary.number("CRVAL1") + 4.0).abs() < 1e-12); // -5 mm edge, 2 mm pixels
    assert!((primary.number("CDELT2") - 2.0).abs() < 1e-12);
    assert_eq!(primary.value("BUNIT").unwrap(), "W/m2");
    assert_eq!(primary.value("SEED").unwrap(), u64::MAX.to_string());
}

#[test]
fn long_and_foreign_names_stay_within_printable_cards() {
    let system = "Fernröhre 'mit' Blenden ".repeat(9);
    let bytes = file(&map(2, 2), &system);
    let primary = &units(&bytes)[0];
    assert!(primary.cards.iter().all(|card| card.bytes().all(|byte| (32..127).contains(&byte))));
    assert!(primary.cards.iter().any(|card| card.starts_with("CONTINUE  '")));
}
