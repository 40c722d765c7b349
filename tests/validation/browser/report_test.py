"""Opens reports in a browser and uses them: report_test.py REPORT_PAGES FOLDER

REPORT_PAGES is the program that writes the reports; FOLDER gets them and screenshots of them. With
AXE=.../axe.min.js in the environment the accessibility rules of axe-core are checked, too.
"""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
from pages import HEIGHT, READY, WIDTH, Pages, ramp
from webdriver import missing


class Report(Pages):
    # ---- the page of a case

    def test_divider(self):
        self.open('ramp/index.html')
        x, y = 108, 48
        self.assertEqual(self.picture_at(x, y), ramp(x, y, True))
        self.browser.run("const s = document.getElementById('split'); s.value = 90;"
                         "s.dispatchEvent(new Event('input'))")
        self.assertEqual(self.picture_at(x, y), ramp(x, y, False))
        # With the keyboard.
        self.browser.run("document.getElementById('split').focus()")
        self.browser.keys(*['left'] * 4)
        self.assertEqual(float(self.browser.run("return document.getElementById('split').value")),
                         88)
        # By dragging it.
        left, top, width, height = self.box()
        self.browser.pointer((left + 0.88 * width, top + height / 2), 'down',
                             (left + 0.3 * width, top + height / 2), 'up')
        self.assertAlmostEqual(
            float(self.browser.run("return document.getElementById('split').value")), 30, delta=1)
        self.assertEqual(self.picture_at(x, y), ramp(x, y, True))

    def test_blink(self):
        self.open('ramp/index.html')
        self.mode('blink')
        x, y = 108, 48
        self.assertEqual(self.picture_at(x, y), ramp(x, y, False))
        time.sleep(0.8)
        self.assertEqual(self.picture_at(x, y), ramp(x, y, False), 'blinks unasked')
        self.browser.click('#swap')
        self.assertEqual(self.picture_at(x, y), ramp(x, y, True))
        self.assertIn('POV-Ray', self.browser.text('#shown'))
        self.browser.click('#blink')
        self.assertEqual(self.browser.run(
            "return document.getElementById('blink').getAttribute('aria-pressed')"), 'true')
        seen = {tuple(self.picture_at(x, y)) for _ in range(30) if not time.sleep(0.05)}
        self.assertEqual(seen, {tuple(ramp(x, y, False)), tuple(ramp(x, y, True))})
        self.browser.click('#blink')
        before = self.picture_at(x, y)
        time.sleep(0.8)
        self.assertEqual(self.picture_at(x, y), before)
        self.browser.run("document.getElementById('canvas').focus()")
        self.browser.keys(' ')
        self.assertNotEqual(self.picture_at(x, y), before)

    def test_other_modes(self):
        self.open('ramp/index.html')
        self.mode('difference')
        self.assertEqual(self.picture_at(20, 20), [0, 0, 0])
        self.assertEqual(self.picture_at(108, 48), [255, 255, 255])
        self.browser.run("const g = document.getElementById('gain'); g.value = 4;"
                         "g.dispatchEvent(new Event('change'))")
        self.assertEqual(self.picture_at(108, 48), [80, 80, 80])
        self.mode('flip')
        self.assertEqual(self.picture_at(20, 20), [0, 0, 4])
        self.assertGreater(sum(self.picture_at(108, 48)), 50)
        self.assertTrue(self.browser.run(
            "return document.querySelector('[data-mode=flip] .bar').offsetWidth > 100"))
        self.mode('side')
        # Both halves show the same place: the panes are 4 pixels apart.
        left, top, width, height = self.box()
        middle, scale = (width - 4) / 4, self.fitted()
        dx, dy = (108.5 - WIDTH / 2) * scale, (48.5 - HEIGHT / 2) * scale
        self.assertEqual(self.shown((middle + dx) / width, 0.5 + dy / height), ramp(108, 48, False))
        self.assertEqual(self.shown((width - middle + dx) / width, 0.5 + dy / height),
                         ramp(108, 48, True))

    def test_inspector(self):
        self.open('ramp/index.html')
        for x, y in (3, 5), (108, 48), (159, 119):
            self.browser.pointer(self.at(x, y))
            self.settle()
            self.assertEqual(self.browser.text('#where'), 'Pixel (%d, %d)' % (x, y))
            for row, reference in ('of-test', False), ('of-reference', True):
                color = ramp(x, y, reference)
                self.assertEqual(self.cells(row), [str(v) for v in color] +
                                 ['#%02x%02x%02x' % tuple(color)])
        self.assertEqual(self.cells('of-difference'), ['0', '0', '0', ''])
        # With the keyboard, from the worst pixel on.
        self.browser.pointer(self.at(108, 48))
        self.browser.run("document.getElementById('canvas').focus()")
        self.browser.keys('right', 'right', 'down', 'shift+left', 'up')
        self.assertEqual(self.browser.text('#where'), 'Pixel (100, 48)')
        self.assertEqual(self.cells('of-difference'), ['−20', '−20', '−20', ''])
        self.assertGreater(float(self.cells('of-flip')[0]), 0.01)
        time.sleep(0.5)
        self.assertIn('Pixel 100, 48. penumbra: 100 48 152. POV-Ray: 120 68 172',
                      self.browser.run("return document.getElementById('said').textContent"))

    def test_zoom_and_pan(self):
        self.open('ramp/index.html')
        start = self.fitted()
        x, y = self.at(108, 48)
        for _ in range(6):
            self.browser.wheel(x, y, -240)
        self.settle()
        near = self.fitted()
        self.assertGreater(near, 4 * start)
        self.browser.pointer((x + 1, y))
        self.assertEqual(self.browser.text('#where'), 'Pixel (108, 48)', 'zooms about the pointer')
        self.browser.pointer((x, y), 'down', (x - 5 * near, y + 2 * near), 'up')
        self.browser.pointer((x + 1, y))
        self.assertEqual(self.browser.text('#where'), 'Pixel (113, 46)')
        self.browser.click('[data-zoom=out]')
        self.assertLess(self.fitted(), near)
        self.browser.click('[data-zoom=one]')
        self.assertEqual(self.fitted(), 1)
        self.browser.click('[data-zoom=fit]')
        self.assertEqual(self.fitted(), start)
        self.browser.run("document.getElementById('canvas').focus()")
        self.browser.keys('+', '+')
        self.assertGreater(self.fitted(), start)
        self.browser.keys('0')
        self.assertEqual(self.fitted(), start)
        self.browser.fingers(((x - 20, y), (x - 80, y)), ((x + 20, y), (x + 80, y)))
        self.settle()
        self.assertGreater(self.fitted(), 2 * start)

    def test_worst_tiles(self):
        self.open('ramp/index.html')
        self.browser.click('.go')
        self.settle()
        self.assertGreaterEqual(self.fitted(), 36)
        x, y = map(int, re.findall(r'\d+', self.browser.text('#where')))
        self.assertTrue(100 <= x < 116 and 40 <= y < 56)
        self.assertTrue(self.browser.run("return document.activeElement.id === 'canvas'"))
        self.browser.screenshot(self.folder / 'values.png')

    def test_unequal_sizes(self):
        self.open('sizes/index.html')
        modes = self.browser.run("return [...document.getElementsByName('mode')]"
                                 ".map((radio) => radio.value)")
        self.assertEqual(modes, ['slider', 'blink', 'side'])
        self.browser.pointer(self.at(120, 80))
        self.assertEqual(self.cells('of-reference'), ['–'] * 4)
        self.assertEqual(self.cells('of-test')[:3], [str(v) for v in ramp(120, 80, False)])

    def test_without_pictures(self):
        self.open('broken/index.html')
        page = self.browser.text('body')
        self.assertIn('broken.pov:12: povray: Parse Error: No matching }, { found', page)
        self.assertIn('found instead', page)
        self.assertIn('error', page)

    def test_without_script(self):
        self.browser.cdp('Emulation.setScriptExecutionDisabled', value=True)
        try:
            self.browser.go((self.folder / 'ramp/index.html').as_uri())
            self.browser.screenshot(self.folder / 'no-script.png')
        finally:
            self.browser.cdp('Emulation.setScriptExecutionDisabled', value=False)
        self.assertTrue(self.browser.run(
            "return document.getElementById('viewer').hidden &&"
            "[...document.querySelectorAll('#pictures img')].every((i) => i.offsetWidth > 100)"))
        self.assertIn('parity', self.browser.text('.figures'))

    # ---- the list

    def names(self):
        return self.browser.run(
            "return [...document.querySelectorAll('#cases tbody tr')].filter((r) => !r.hidden)"
            ".map((r) => r.querySelector('th').dataset.key)")

    def sort_by(self, column):
        self.browser.run("[...document.querySelectorAll('#cases thead button')]"
                         ".find((b) => b.textContent === arguments[0]).click()", column)
        return self.browser.run(
            "return [...document.querySelectorAll('#cases tbody tr')].filter((r) => !r.hidden).map"
            "((r) => r.querySelector(`[data-name=\"${arguments[0]}\"]`).dataset.key)", column)

    def test_list(self):
        self.open('index.html')
        self.assertEqual(len(self.names()), 5)
        self.assertEqual(self.names()[0], 'broken', 'the worst is not first')
        self.assertEqual(self.names()[-1], 'same')
        self.assertIn('5 of 5 shown', self.browser.text('#count'))
        self.assertEqual(self.sort_by('scene')[1:], ['broken', 'ramp', 'same', 'sizes'])
        self.assertEqual(self.browser.run(
            "return [...document.querySelectorAll('[aria-sort]')].map((th) => th.textContent +"
            "th.getAttribute('aria-sort'))"), ['sceneascending'])
        self.assertEqual(self.sort_by('scene')[:2], ['sizes', 'same'])
        values = [float(v) for v in self.sort_by('flip') if v]
        self.assertEqual(values, sorted(values, reverse=True))
        self.assertEqual(self.sort_by('flip')[-1], '', 'unknown values are not last')
        # Thumbnails are files beside the page; what ended in an error has none.
        loaded = self.browser.run_async('''
            const images = [...document.images], done = arguments[0];
            Promise.all(images.map((i) => { i.loading = 'eager'; return i.decode(); }))
                .then(() => done(images.map((i) => i.naturalWidth)), (e) => done(String(e)));''')
        self.assertEqual(len(loaded), 4)
        self.assertTrue(all(width > 100 for width in loaded), loaded)

    def test_filter(self):
        self.open('index.html')
        self.browser.write('#find', 'SAM')
        self.assertEqual(self.names(), ['same'])
        self.assertIn('1 of 5 shown', self.browser.text('#count'))
        self.browser.write('#find', 'qqq')
        self.assertEqual(self.names(), [])
        self.assertEqual(self.browser.text('#none'), 'No case matches.')
        self.browser.run("const f = document.getElementById('find'); f.value = '';"
                         "f.dispatchEvent(new Event('input'))")
        self.browser.click('[name=verdict][value=fail]')
        self.assertEqual(self.names(), ['broken', 'sizes', 'same'])
        self.browser.click('[name=verdict][value=error]')
        self.assertEqual(self.names(), ['sizes', 'same'])
        self.browser.click('[name=verdict][value=fail]')
        self.assertIn('ramp', self.names())

    def test_links(self):
        self.open('index.html')
        for name in 'ramp', 'hostile':
            self.browser.run("[...document.querySelectorAll('#cases tbody th a')].find("
                             "(a) => a.href.includes(arguments[0])).click()",
                             {'ramp': '/ramp/', 'hostile': 'folder'}[name])
            self.browser.run_async(READY)
            self.assertTrue(self.browser.run("return !!document.getElementById('canvas')"), name)
            self.browser.click('header nav a')
            self.assertTrue(self.browser.run("return !!document.getElementById('cases')"), name)
        self.open('ramp/index.html')
        self.assertEqual(self.browser.run(
            "return [...document.querySelectorAll('main a')].map((a) => a.getAttribute('href'))"),
            ['./ramp.pov', './povray.exr'])
        self.open('single/index.html')
        self.assertFalse(self.browser.run("return !!document.querySelector('header nav')"))

    def test_thousand_cases(self):
        self.open('thousand/index.html')
        self.assertEqual(len(self.names()), 1000)
        start = time.monotonic()
        values = [float(v) for v in self.sort_by('ssim')]
        self.browser.write('#find', 'model-99')
        taken = time.monotonic() - start
        self.assertEqual(values, sorted(values))
        self.assertEqual(len(self.names()), 11)
        print('thousand cases sorted and filtered in %.2f s' % taken)
        self.assertLess(taken, 5)

    # ---- both

    def test_hostile_texts(self):
        for page in 'a "folder" & more?#%/index.html', 'index.html':
            self.open(page)
            time.sleep(0.2)
            self.assertEqual(self.browser.run("return [...document.images].filter("
                                              "(i) => i.src.endsWith('/x')).length"), 0)
            self.assertEqual(self.browser.run("return document.scripts.length"), 1)
            self.assertIn('"><img src=x onerror=alert(1)></script>', self.browser.text('body'))
            for mark in '\x1b', '\u202e':
                self.assertNotIn(mark, self.browser.run('return document.body.textContent'))
            self.assertEqual(self.browser.run(
                "return [...document.links].filter((a) => !a.href.startsWith('file:')).length"), 0)
            self.assertFalse(self.browser.has_dialog())

    def test_policy(self):
        for page in 'ramp/index.html', 'index.html':
            source = (self.folder / page).read_text(encoding='utf-8')
            policy = re.search(r'Content-Security-Policy" content="([^"]*)"', source)[1]
            self.assertIn("default-src 'none'", policy)
            scripts = re.findall(r'<script>(.*?)</script>', source, re.S)
            self.assertEqual(len(scripts), 1)
            digest = base64.b64encode(hashlib.sha256(scripts[0].encode()).digest()).decode()
            self.assertIn("script-src 'sha256-%s';" % digest, policy)
            # The browser obeys it: a script that is written into the page does not run.
            changed = source.replace('</main>', '<script>document.title = "ran"</script></main>')
            self.assertNotEqual(changed, source)
            (self.folder / 'changed.html').write_text(changed, encoding='utf-8')
            self.browser.go((self.folder / 'changed.html').as_uri())
            self.assertNotEqual(self.browser.run('return document.title'), 'ran')
            refused = [e for e in self.browser.log('browser') if 'Content Security' in e['message']]
            self.assertTrue(refused)
            (self.folder / 'changed.html').unlink()

    def test_widths(self):
        pages = {'case': 'ramp/index.html', 'list': 'index.html', 'sizes': 'sizes/index.html',
                 'hostile': 'a "folder" & more?#%/index.html', 'error': 'broken/index.html',
                 'thousand': 'thousand/index.html'}
        for width in 360, 768, 1280:
            self.browser.size(width, 780)
            for name, page in pages.items():
                self.open(page)
                self.settle()
                wide = self.browser.run('return document.documentElement.scrollWidth')
                self.assertLessEqual(wide, width, name)
                if name in ('case', 'list') and width == 360:
                    self.browser.screenshot(self.folder / (name + '-phone.png'))

    def test_screenshots(self):
        for scheme in 'light', 'dark':
            self.browser.media(scheme)
            for name, page in ('case', 'ramp/index.html'), ('list', 'index.html'):
                self.open(page)
                self.settle()
                self.browser.screenshot(self.folder / ('%s-%s.png' % (name, scheme)))
                self.assertGreater((self.folder / ('%s-%s.png' % (name, scheme))).stat().st_size, 10000)

    def test_accessibility(self):
        axe = os.environ.get('AXE', '')
        if not axe:
            self.skipTest('AXE does not name an axe.min.js')
        source = pathlib.Path(axe).read_text(encoding='utf-8')
        found = {}
        for scheme in 'light', 'dark':
            for width in 1280, 360:
                self.browser.media(scheme)
                self.browser.size(width, 800)
                for page in 'ramp', 'sizes', 'broken', '.':
                    self.open(page + '/index.html')
                    for mode in ('slider', 'blink', 'difference', 'flip') if page == 'ramp' else '-':
                        if mode != '-':
                            self.mode(mode)
                        self.browser.run(source)
                        result = self.browser.run_async(
                            'const done = arguments[0]; axe.run(document).then(done, done);')
                        for v in result['violations']:
                            nodes = [node['html'][:160] for node in v['nodes'][:3]]
                            key = v['impact'], v['id'], page
                            found.setdefault(key, (scheme, width, v['help'], nodes))
        for key, what in sorted(found.items()):
            print(*key, *what, sep='\n    ')
        print('axe-core: %d kinds of findings' % len(found))
        self.assertEqual([key for key in found if key[0] in ('serious', 'critical')], [])


if __name__ == '__main__':
    if missing():
        print('SKIPPED: ' + missing())
        sys.exit(0)
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2]).absolute()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    Pages.folder = folder
    subprocess.run([program, folder], check=True)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
