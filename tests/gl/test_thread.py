"""A call from another thread runs in the thread of the context, if that thread runs an event loop."""

import asyncio
import threading
import time

import pytest

import aolab
from aolab import ContextError, ParameterError
from aolab.gl import thread


async def elsewhere(call):
    """Run `call` in another thread, as JupyterLab runs the callbacks of widgets."""
    return await asyncio.to_thread(call)


def test_a_render_from_another_thread_is_that_of_this_thread(lab, boxes):
    here = lab.render(boxes, "ssao")

    async def notebook():
        lab.render(boxes, "ssao")
        return await elsewhere(lambda: lab.render(boxes, "ssao").image)

    assert (asyncio.run(notebook()) == here.image).all()


def test_buffers_are_read_and_labs_are_made_from_another_thread(lab, boxes):
    def callback():
        frame = aolab.Lab((16, 12)).render(boxes, "s3ho")
        return frame["sh0"].shape, frame["visibility"].shape

    async def notebook():
        lab.render(boxes, "ssao")
        return await elsewhere(callback)

    assert asyncio.run(notebook()) == ((12, 16, 4), (12, 16))


def test_an_error_reaches_the_caller(lab, boxes):
    async def notebook():
        lab.render(boxes, "ssao")
        with pytest.raises(ParameterError, match="radios"):
            await elsewhere(lambda: lab.render(boxes, "ssao", radios=1))

    asyncio.run(notebook())


def test_without_a_loop_the_error_names_the_way_in_a_notebook(lab, boxes):
    caught = []

    def call():
        try:
            lab.render(boxes, "ssao")
        except ContextError as error:
            caught.append(str(error))

    other = threading.Thread(target=call)
    other.start()
    other.join()
    assert "In a notebook" in caught[0]


def test_a_cell_that_waits_for_its_own_callback_ends_with_an_error(lab, boxes, monkeypatch):
    monkeypatch.setattr(thread, "PATIENCE", 0.2)
    caught = []

    def call():
        try:
            lab.render(boxes, "ssao")
        except ContextError as error:
            caught.append(str(error))

    async def cell():
        lab.render(boxes, "ssao")
        other = threading.Thread(target=call, name="callback")
        other.start()
        other.join()  # the loop stands still

    asyncio.run(cell())
    assert "'callback' within 0.2 s" in caught[0]
    assert "do not wait in a cell" in caught[0]


def test_a_posted_call_does_not_wait(lab, boxes):
    seen = []

    async def notebook():
        lab.render(boxes, "ssao")
        await elsewhere(lambda: thread.post(lambda: seen.append(threading.get_ident())))
        while not seen:
            await asyncio.sleep(0)

    asyncio.run(notebook())
    assert seen == [threading.get_ident()]
    thread.post(lambda: seen.append(time.monotonic()))
    assert len(seen) == 2
