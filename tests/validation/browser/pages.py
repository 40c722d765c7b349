"""What tests of a report's pages share: an open browser, and what the ramp of pages.cpp shows."""
import json
import pathlib
import unittest

from webdriver import Browser

PIXEL = '''
  const canvas = document.getElementById('canvas'), box = canvas.getBoundingClientRect();
  const at = canvas.getContext('2d').getImageData(
      Math.round(arguments[0] * canvas.width), Math.round(arguments[1] * canvas.height), 1, 1);
  return [...at.data].slice(0, 3);'''
# The picture is drawn in the next frame.
SETTLED = 'const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));'
READY = '''
  const done = arguments[0], viewer = document.getElementById('viewer');
  const wait = () => !viewer || !viewer.hidden ? done() : setTimeout(wait, 10);
  wait();'''
BOX = '''const b = document.querySelector(arguments[0]).getBoundingClientRect();
  return [b.left, b.top, b.width, b.height];'''
WIDTH, HEIGHT = 160, 120


def ramp(x, y, reference):
    """The formula of pages.cpp."""
    more = 20 if reference and 100 <= x < 116 and 40 <= y < 56 else 0
    return [x + more, y + more, 200 - y + more]


class Pages(unittest.TestCase):
    folder = pathlib.Path()  # of the reports
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.size(1280, 900)
        self.browser.media()
        for kind in 'browser', 'performance':
            self.browser.log(kind)

    def tearDown(self):
        self.assertFalse(self.browser.has_dialog(), 'a dialog is open')
        # That a canvas is read often is this test's own doing.
        errors = [e for e in self.browser.log('browser') if e['level'] in ('SEVERE', 'WARNING')
                  and 'willReadFrequently' not in e['message']]
        self.assertEqual(errors, [], 'the console has errors')
        for entry in self.browser.log('performance'):
            message = json.loads(entry['message'])['message']
            if message['method'] == 'Network.requestWillBeSent':
                self.assertRegex(message['params']['request']['url'], '^(file|data):')

    def open(self, page):
        self.browser.go((self.folder / page).as_uri())
        self.browser.run_async(READY)
        self.browser.run("document.getElementById('stage')?.scrollIntoView({block: 'center'})")

    def settle(self):
        self.browser.run_async(SETTLED)

    def box(self, selector='#canvas'):
        return self.browser.run(BOX, selector)

    def mode(self, name):
        self.browser.run("document.querySelector('[name=mode][value=%s]').click()" % name)
        self.settle()

    def shown(self, x, y):
        """The colour that the canvas shows at a fraction of its width and height."""
        self.settle()
        return self.browser.run(PIXEL, x, y)

    def at(self, x, y):
        """Where pixel (x, y) of the ramp is in the viewport when it fits the canvas."""
        left, top, width, height = self.box()
        scale = self.fitted()
        return (left + width / 2 + (x + 0.5 - WIDTH / 2) * scale,
                top + height / 2 + (y + 0.5 - HEIGHT / 2) * scale)

    def fitted(self):
        return int(self.browser.text('#zoom').split()[0]) / 100

    def cells(self, row):
        return self.browser.run(
            "return [...document.querySelectorAll('#' + arguments[0] + ' td')]"
            ".map((cell) => cell.textContent)", row)

    def picture_at(self, x, y):
        """The colour that the canvas shows for pixel (x, y) of the ramp."""
        left, top, width, height = self.box()
        u, v = self.at(x, y)
        return self.shown((u - left) / width, (v - top) / height)
