"""Every error is described as what it is: a problem."""

from fastapi import FastAPI

from shared.web.openapi import MEDIA_TYPE, with_problems


def described():
    app = FastAPI()

    @app.get("/places/{number}")
    def place(number: int) -> dict[str, int]:
        return {"number": number}

    plain = app.openapi()
    return plain, with_problems(plain)


def test_every_operation_ends_in_success_or_a_problem():
    _, document = described()
    answers = document["paths"]["/places/{number}"]["get"]["responses"]
    assert set(answers) == {"200", "4XX", "5XX"}
    assert set(answers["4XX"]["content"]) == {MEDIA_TYPE}
    assert "Problem" in document["components"]["schemas"]
    assert "HTTPValidationError" not in document["components"]["schemas"]


def test_the_given_document_stays_as_it_is():
    plain, _ = described()
    assert "422" in plain["paths"]["/places/{number}"]["get"]["responses"]
